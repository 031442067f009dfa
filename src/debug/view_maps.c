/* view_maps.c: single splats with their depth maps, before anything is summed or normalized (Hoet
 * 2014, figure 14): above, what some splats light in the picture, each with its number; below,
 * their maps.
 *
 * In the picture each splat gives its colour times the cosine, the same over all of its disc and
 * whatever its size, so that the sharp shadows of small and large ones can be told. In a map grey
 * is depth, white where it is nearest to the light; blue texels met nothing, and those outside of
 * the disc, which light nothing, are dimmed.
 */
#include "debug/backdrop.h"
#include "debug/debug.h"
#include "debug/font.h"
#include "debug/project.h"
#include "debug/selection.h"
#include "host/photons.h"
#include "host/splats.h"
#include "image/magnify.h"
#include "image/tonemap.h"
#include "placement/placement.h"
#include <psplat/math.h>
#include <stdio.h>
#include <stdlib.h>

#define USUAL_COUNT 12
#define COLUMNS 6
#define BATCH 4096 /* splats placed at a time */

static const struct colour ink = {255, 220, 120};

static void offer_splats(struct render *render, const ps_photon *photons, size_t n,
                         struct splat *placed, struct selection *splats)
{
    for (size_t first = 0; first < n; first += BATCH) {
        size_t count = n - first < BATCH ? n - first : BATCH;
        photons_place(render, photons + first, count, placed);
        for (size_t i = 0; i < count; i++) {
            float x, y;
            const ps_bundle *bundle = &placed[i].bundle;
            ps_vec3 back = ps_scale(bundle->axis_w, -1.0f);
            if (bundle->radius > 0.0f && project_visible(render, bundle->centre, back, &x, &y))
                selection_offer(splats, &placed[i]);
        }
    }
}

/* Chooses among the splats whose middles are seen. */
static ps_result choose_splats(struct render *render, struct selection *splats, struct error *error)
{
    const ps_photon *photons;
    size_t n = 0;
    const ps_host *host = own_host(render);
    struct splat *placed = malloc(BATCH * sizeof *placed);
    if (!placed)
        return error_memory(error, BATCH * sizeof *placed, "splats");
    ps_result result;
    do {
        result = photon_stream_next(&render->photons, &photons, &n, error);
        if (result == PS_OK)
            offer_splats(render, photons, n, placed, splats);
        host->progress(host, photon_stream_progress(&render->photons));
    } while (result == PS_OK && n > 0);
    free(placed);
    selection_finish(splats);
    if (result == PS_OK && splats->count == 0)
        return error_set(error, PS_ERROR_INVALID, "maps: no splat is in the picture");
    return result;
}

static struct colour dim(struct colour colour)
{
    return (struct colour){colour.r / 3, colour.g / 3, colour.b / 3};
}

/* Draws a map of resolution^2 depths, a pixel a texel. The range of greys is the depths', but no
 * less than the splat's radius, so that what is flat looks flat. */
static void draw_texels(const float *depths, uint32_t resolution, float half_width, uint8_t *rgb)
{
    static const struct colour nothing = {40, 70, 190};
    float nearest = INFINITY, farthest = -INFINITY;
    for (uint32_t i = 0; i < resolution * resolution; i++)
        if (depths[i] < INFINITY) {
            nearest = fminf(nearest, depths[i]);
            farthest = fmaxf(farthest, depths[i]);
        }
    float range = fmaxf(farthest - nearest, half_width);
    struct canvas texels = {resolution, resolution, rgb};
    float half = 0.5f * (float)resolution;
    for (uint32_t i = 0; i < resolution * resolution; i++) {
        uint32_t column = i % resolution, line = i / resolution;
        float u = ((float)column + 0.5f) / half - 1.0f;
        float v = ((float)line + 0.5f) / half - 1.0f;
        float share = 1.0f - 0.85f * (depths[i] - nearest) / range;
        uint8_t grey = depths[i] < INFINITY ? (uint8_t)(255.0f * share) : 0;
        struct colour colour = depths[i] < INFINITY ? (struct colour){grey, grey, grey} : nothing;
        canvas_set(&texels, (long)column, (long)line, u * u + v * v < 1.0f ? colour : dim(colour));
    }
}

/* Where the maps are on the sheet. */
struct layout {
    uint32_t resolution;
    size_t top; /* of the first row of cells */
    size_t cell_width, cell_height, zoom, scale;
};

static struct layout layout_of(const struct render *render, uint32_t resolution)
{
    size_t scale = canvas_text_scale(render->film.width);
    size_t cell = render->film.width / COLUMNS, margin = 4 * scale;
    size_t room = cell > margin ? (cell - margin) / resolution : 1;
    size_t zoom = room > 0 ? room : 1, side = zoom * resolution;
    return (struct layout){
        .resolution = resolution,
        .top = render->film.height,
        .cell_width = side + margin > cell ? side + margin : cell,
        .cell_height = side + margin + (FONT_HEIGHT + 4) * scale,
        .zoom = zoom,
        .scale = scale,
    };
}

static ps_result draw_map(const struct layout *layout, size_t index, const struct splat *splat,
                          const float *depths, struct canvas *canvas)
{
    uint32_t side = layout->resolution;
    size_t left = index % COLUMNS * layout->cell_width + 2 * layout->scale;
    size_t top = layout->top + index / COLUMNS * layout->cell_height + 2 * layout->scale;
    uint8_t *texels = malloc(3 * (size_t)side * side);
    uint8_t *large = malloc(3 * (size_t)side * side * layout->zoom * layout->zoom);
    if (texels && large) {
        char text[64];
        snprintf(text, sizeof text, "%zu R=%.3g", index + 1, (double)splat->bundle.radius);
        canvas_text(canvas, (long)left, (long)top, layout->scale, ink, text);
        draw_texels(depths, side, splat->bundle.radius, texels);
        magnify(texels, side, (struct rectangle){0, 0, side, side}, layout->zoom, large);
        canvas_paste(canvas, left, top + (FONT_HEIGHT + 2) * layout->scale, large,
                     side * layout->zoom, side * layout->zoom);
    }
    bool good = texels && large;
    free(texels);
    free(large);
    return good ? PS_OK : PS_ERROR_MEMORY;
}

static ps_result draw_maps(const struct render *render, const struct layout *layout,
                           const struct splat *splats, size_t n, struct canvas *canvas,
                           struct error *error)
{
    const struct strategy *visibility = strategy_in(render, PS_VISIBILITY);
    size_t texels = (size_t)layout->resolution * layout->resolution;
    float *depths = malloc(texels * sizeof *depths);
    if (!depths)
        return error_memory(error, texels * sizeof *depths, "a depth map");
    ps_result result = PS_OK;
    for (size_t i = 0; i < n && result == PS_OK; i++) {
        visibility->type->table.visibility.depth_maps(
            visibility->state, visibility->host, &splats[i].bundle, 1, layout->resolution, depths);
        result = draw_map(layout, i, &splats[i], depths, canvas);
    }
    free(depths);
    return result == PS_OK ? PS_OK : error_memory(error, 3 * texels, "a map");
}

/* Luminance of a splat of mean power, on a white surface that faces it. */
#define SPLAT_BRIGHTNESS 0.5f

static float scale_of(const struct splat *splats, size_t n)
{
    float sum = 0.0f;
    for (size_t i = 0; i < n; i++)
        sum += ps_luminance(splats[i].power);
    return sum > 0.0f ? SPLAT_BRIGHTNESS * (float)n / sum : 0.0f;
}

/* Adds what the splats gave to the tiles to the picture in the canvas. */
static void draw_light(const struct render *render, float scale, double exposure,
                       struct canvas *canvas)
{
    const struct gbuffer *gbuffer = &render->gbuffer;
    for (size_t i = 0; i < (size_t)gbuffer->tile_count * PS_TILE_PIXELS; i++) {
        uint32_t x, y, index = (uint32_t)(i / PS_TILE_PIXELS), lane = i % PS_TILE_PIXELS;
        const ps_tile *tile = &gbuffer->tiles[index];
        if (!(tile->weight[lane] > 0.0f) || !gbuffer_pixel(gbuffer, index, lane, &x, &y))
            continue;
        float light[3] = {tile->irradiance_r[lane], tile->irradiance_g[lane],
                          tile->irradiance_b[lane]};
        for (int c = 0; c < 3 && gbuffer->splatted; c++)
            light[c] += gbuffer_splatted(gbuffer, index, c)[lane];
        double under = tonemap_linear((double)canvas_get(canvas, x, y).r / 255.0);
        float r = scale * light[0] * tile->albedo_r[lane] + (float)under;
        float g = scale * light[1] * tile->albedo_g[lane] + (float)under;
        float b = scale * light[2] * tile->albedo_b[lane] + (float)under;
        uint8_t rgb[3];
        tonemap_planes(&r, &g, &b, 1, exposure, TONE_FILMIC, rgb);
        canvas_set(canvas, (long)x, (long)y, (struct colour){rgb[0], rgb[1], rgb[2]});
    }
}

static void number_splats(const struct render *render, const struct splat *splats, size_t n,
                          struct canvas *canvas)
{
    size_t scale = canvas_text_scale(render->film.width);
    for (size_t i = 0; i < n; i++) {
        float x, y;
        char text[32];
        if (!camera_project(&render->scene->camera, splats[i].bundle.centre, &x, &y))
            continue;
        snprintf(text, sizeof text, "%zu", i + 1);
        canvas_text(canvas, lroundf(x) - (long)canvas_text_width(scale, text) / 2,
                    lroundf(y) - (long)(FONT_HEIGHT * scale / 2), scale, ink, text);
    }
}

static ps_result draw_picture(struct render *render, struct splat *splats, size_t n,
                              double exposure, struct canvas *canvas, struct error *error)
{
    render->counts_splats = true;
    ps_result result = splats_begin(render, 1, error);
    if (result == PS_OK)
        result = splatter_add(&render->splatter, splats, n, error);
    if (result != PS_OK)
        return result;
    splatter_end_pass(&render->splatter, &render->gbuffer);
    backdrop_draw(render, exposure, canvas);
    draw_light(render, scale_of(splats, n), exposure, canvas);
    number_splats(render, splats, n, canvas);
    return PS_OK;
}

static ps_result draw_sheet(struct render *render, uint32_t resolution,
                            const struct selection *chosen, double exposure, struct canvas *canvas,
                            struct error *error)
{
    struct layout layout = layout_of(render, resolution);
    size_t n = chosen->count, rows = (n + COLUMNS - 1) / COLUMNS;
    size_t width = COLUMNS * layout.cell_width;
    struct splat *splats = malloc(n * sizeof *splats);
    if (!splats)
        return error_memory(error, n * sizeof *splats, "splats");
    for (size_t i = 0; i < n; i++)
        splats[i] = *(const struct splat *)selection_item(chosen, i);
    ps_result result =
        canvas_create(canvas, width > render->film.width ? width : render->film.width,
                      layout.top + rows * layout.cell_height, error);
    if (result == PS_OK)
        result = draw_maps(render, &layout, splats, n, canvas, error);
    if (result == PS_OK)
        result = draw_picture(render, splats, n, exposure, canvas, error);
    free(splats);
    return result;
}

static ps_result draw(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error)
{
    (void)part;
    const struct strategy *visibility = strategy_in(render, PS_VISIBILITY);
    const struct footprint_params *footprint = strategy_shared(visibility);
    uint32_t resolution = (uint32_t)footprint->resolution;
    if (!visibility->type->table.visibility.depth_maps)
        return error_set(error, PS_ERROR_INVALID, "maps: the visibility %s has no depth maps",
                         visibility->type->name);
    struct selection splats;
    ps_result result = selection_create(&splats, options->count ? options->count : USUAL_COUNT,
                                        sizeof(struct splat), error);
    if (result != PS_OK)
        return result;
    result = choose_splats(render, &splats, error);
    if (result == PS_OK)
        result = draw_sheet(render, resolution, &splats, options->exposure, canvas, error);
    selection_release(&splats);
    return result;
}

const struct debug_view debug_maps = {.name = "maps", .draw = draw};
