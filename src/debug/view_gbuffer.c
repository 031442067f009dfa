/* view_gbuffer.c: what each pixel sees, as the estimators get it (Hoet 2014, figure 8): one picture
 * of all layers with their names, or one layer by itself. Black where nothing is seen.
 */
#include "debug/debug.h"
#include "debug/font.h"
#include "debug/id_colour.h"
#include "image/tonemap.h"
#include <psplat/tile.h>
#include <stdio.h>
#include <string.h>

#define COLUMNS 3

/* A pixel of the G-buffer, and what its colour depends on besides. */
struct pixel {
    const struct render *render;
    const ps_tile *tile;
    uint32_t lane;
    size_t index;         /* in the tiles */
    float nearest, depth; /* depth: from the nearest to the farthest pixel */
    double exposure;
};

static struct colour from_shares(ps_rgb share)
{
    float channels[3] = {share.r, share.g, share.b};
    uint8_t bytes[3];
    for (int c = 0; c < 3; c++)
        bytes[c] = (uint8_t)(255.0f * fminf(fmaxf(channels[c], 0.0f), 1.0f) + 0.5f);
    return (struct colour){bytes[0], bytes[1], bytes[2]};
}

static struct colour from_light(ps_rgb light, double exposure)
{
    uint8_t rgb[3];
    tonemap_planes(&light.r, &light.g, &light.b, 1, exposure, TONE_FILMIC, rgb);
    return (struct colour){rgb[0], rgb[1], rgb[2]};
}

static struct colour from_reflectance(ps_rgb reflectance)
{
    return from_shares((ps_rgb){tonemap_srgb(reflectance.r), tonemap_srgb(reflectance.g),
                                tonemap_srgb(reflectance.b)});
}

static ps_rgb albedo_of(const struct pixel *pixel)
{
    const ps_tile *tile = pixel->tile;
    uint32_t lane = pixel->lane;
    return (ps_rgb){tile->albedo_r[lane], tile->albedo_g[lane], tile->albedo_b[lane]};
}

static ps_rgb throughput_of(const struct pixel *pixel)
{
    const ps_tile *tile = pixel->tile;
    uint32_t lane = pixel->lane;
    return (ps_rgb){tile->throughput_r[lane], tile->throughput_g[lane], tile->throughput_b[lane]};
}

static struct colour paint_albedo(const struct pixel *pixel)
{
    return from_reflectance(albedo_of(pixel));
}

/* -1..1 becomes black to white. */
static struct colour paint_normal(const struct pixel *pixel)
{
    const ps_tile *tile = pixel->tile;
    uint32_t lane = pixel->lane;
    return from_shares((ps_rgb){0.5f + 0.5f * tile->normal_x[lane],
                                0.5f + 0.5f * tile->normal_y[lane],
                                0.5f + 0.5f * tile->normal_z[lane]});
}

/* The cube around the scene's sphere becomes the cube of colours. */
static struct colour paint_position(const struct pixel *pixel)
{
    const struct scene *scene = pixel->render->scene;
    ps_vec3 position = ps_tile_position(pixel->tile, pixel->lane);
    ps_vec3 away = ps_scale(ps_subtract(position, scene->center), 0.5f / scene->radius);
    return from_shares((ps_rgb){0.5f + away.x, 0.5f + away.y, 0.5f + away.z});
}

/* White where it is nearest, dark, but not black, where it is farthest. */
static struct colour paint_depth(const struct pixel *pixel)
{
    float past = pixel->tile->depth[pixel->lane] - pixel->nearest;
    float grey = pixel->depth > 0.0f ? 1.0f - 0.9f * past / pixel->depth : 1.0f;
    return from_shares((ps_rgb){grey, grey, grey});
}

static struct colour paint_object(const struct pixel *pixel)
{
    return id_colour(pixel->tile->object[pixel->lane]);
}

static struct colour paint_material(const struct pixel *pixel)
{
    return id_colour(pixel->tile->material[pixel->lane]);
}

static struct colour paint_throughput(const struct pixel *pixel)
{
    return from_reflectance(throughput_of(pixel));
}

/* Reflected to the camera. */
static struct colour paint_direct(const struct pixel *pixel)
{
    ps_rgb reflectance = ps_tile_reflectance(pixel->tile, pixel->lane);
    ps_rgb irradiance = pixel->render->gbuffer.direct[pixel->index];
    return from_light(ps_rgb_scale(ps_rgb_multiply(reflectance, irradiance), 1.0f / PS_PI),
                      pixel->exposure);
}

static struct colour paint_emitted(const struct pixel *pixel)
{
    return from_light(pixel->render->gbuffer.emitted[pixel->index], pixel->exposure);
}

enum { DEPTH = 3, EMITTED = 8, LAYERS = 9 };

static const char *const names[LAYERS + 1] = {"albedo",     "normal", "position",
                                              "depth",      "object", "material",
                                              "throughput", "direct", "emitted"};

static struct colour (*const painters[LAYERS])(const struct pixel *pixel) = {
    paint_albedo,   paint_normal,     paint_position, paint_depth,  paint_object,
    paint_material, paint_throughput, paint_direct,   paint_emitted};

struct depths {
    float nearest, farthest;
};

static struct depths depths_of(const struct gbuffer *gbuffer)
{
    struct depths depths = {INFINITY, 0.0f};
    for (size_t i = 0; i < (size_t)gbuffer->tile_count * PS_TILE_PIXELS; i++) {
        float depth = gbuffer->tiles[i / PS_TILE_PIXELS].depth[i % PS_TILE_PIXELS];
        if (!(depth < INFINITY))
            continue;
        depths.nearest = fminf(depths.nearest, depth);
        depths.farthest = fmaxf(depths.farthest, depth);
    }
    return depths;
}

/* Draws a layer with its upper left corner at (left, top). */
static void paint_layer(const struct render *render, int layer, double exposure, size_t left,
                        size_t top, struct canvas *canvas)
{
    const struct gbuffer *gbuffer = &render->gbuffer;
    struct depths depths = depths_of(&render->gbuffer);
    for (size_t i = 0; i < (size_t)gbuffer->tile_count * PS_TILE_PIXELS; i++) {
        uint32_t x, y, tile = (uint32_t)(i / PS_TILE_PIXELS), lane = i % PS_TILE_PIXELS;
        struct pixel pixel = {
            .render = render,
            .tile = &gbuffer->tiles[tile],
            .lane = lane,
            .index = i,
            .nearest = depths.nearest,
            .depth = depths.farthest - depths.nearest,
            .exposure = exposure,
        };
        bool seen = layer == EMITTED || pixel.tile->object[lane] != PS_NO_OBJECT;
        if (seen && gbuffer_pixel(gbuffer, tile, lane, &x, &y))
            canvas_set(canvas, (long)(left + x), (long)(top + y), painters[layer](&pixel));
    }
}

static void label(const struct render *render, int layer, size_t left, size_t top, size_t scale,
                  struct canvas *canvas)
{
    static const struct colour ink = {230, 230, 230};
    struct depths depths = depths_of(&render->gbuffer);
    char text[96];
    if (layer == DEPTH && depths.farthest > 0.0f)
        snprintf(text, sizeof text, "depth %.5g - %.5g", (double)depths.nearest,
                 (double)depths.farthest);
    else
        snprintf(text, sizeof text, "%s", names[layer]);
    canvas_text(canvas, (long)(left + 2 * scale), (long)(top + 2 * scale), scale, ink, text);
}

static ps_result draw_sheet(const struct render *render, double exposure, struct canvas *canvas,
                            struct error *error)
{
    size_t width = render->film.width, height = render->film.height;
    size_t scale = canvas_text_scale(width), strip = (FONT_HEIGHT + 4) * scale;
    ps_result result = canvas_create(canvas, COLUMNS * width,
                                     (LAYERS + COLUMNS - 1) / COLUMNS * (strip + height), error);
    for (int layer = 0; layer < LAYERS && result == PS_OK; layer++) {
        size_t left = (size_t)(layer % COLUMNS) * width;
        size_t top = (size_t)(layer / COLUMNS) * (strip + height);
        label(render, layer, left, top, scale, canvas);
        paint_layer(render, layer, exposure, left, top + strip, canvas);
    }
    return result;
}

static ps_result draw(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error)
{
    if (part < 0)
        return draw_sheet(render, options->exposure, canvas, error);
    ps_result result = canvas_create(canvas, render->film.width, render->film.height, error);
    if (result == PS_OK)
        paint_layer(render, part, options->exposure, 0, 0, canvas);
    return result;
}

const struct debug_view debug_gbuffer = {.name = "gbuffer", .parts = names, .draw = draw};
