#include "debug/pixel_light.h"

#include "debug/project.h"
#include "host/photons.h"
#include "host/splats.h"
#include <psplat/math.h>
#include <psplat/tile.h>
#include <stdlib.h>

#define BATCH 4096 /* photons placed at a time */

/* Sums of all so far, of which the differences are what single splats bring. */
struct search {
    struct render *render;
    struct pixel_light *light;
    size_t capacity;
    double before[3];
};

static ps_result find_surface(const struct render *render, size_t x, size_t y,
                              struct pixel_light *light, struct error *error)
{
    const struct gbuffer *gbuffer = &render->gbuffer;
    size_t width = render->film.width, height = render->film.height;
    if (x >= width || y >= height)
        return error_set(error, PS_ERROR_INVALID,
                         "pixel: (%zu, %zu) is outside of the picture, which has %zux%zu pixels", x,
                         y, width, height);
    for (size_t i = 0; i < (size_t)gbuffer->tile_count * PS_TILE_PIXELS; i++) {
        const ps_tile *tile = &gbuffer->tiles[i / PS_TILE_PIXELS];
        uint32_t column, row, lane = i % PS_TILE_PIXELS;
        if (!gbuffer_pixel(gbuffer, (uint32_t)(i / PS_TILE_PIXELS), lane, &column, &row) ||
            column != x || row != y || tile->object[lane] == PS_NO_OBJECT)
            continue;
        light->position = ps_tile_position(tile, lane);
        light->normal = ps_tile_normal(tile, lane);
        return PS_OK;
    }
    return error_set(error, PS_ERROR_INVALID, "pixel: nothing is seen at (%zu, %zu)", x, y);
}

static ps_result add_source(struct search *search, const ps_photon *photon, ps_rgb irradiance,
                            struct error *error)
{
    struct pixel_light *light = search->light;
    if (light->source_count == search->capacity) {
        size_t capacity = 2 * search->capacity + 256;
        struct pixel_source *sources = realloc(light->sources, capacity * sizeof *sources);
        if (!sources)
            return error_memory(error, capacity * sizeof *sources, "sources of light");
        light->sources = sources;
        search->capacity = capacity;
    }
    light->sources[light->source_count++] = (struct pixel_source){.position = photon->position,
                                                                  .normal = photon->normal,
                                                                  .irradiance = irradiance,
                                                                  .bounce = photon->bounce};
    return PS_OK;
}

static ps_result try_splat(struct search *search, const ps_photon *photon, struct splat *splat,
                           struct error *error)
{
    struct splatter *splatter = &search->render->points;
    ps_rgb sum;
    if (!(splat->bundle.radius > 0.0f) || !splatter_touches(splatter, splat))
        return PS_OK;
    ps_result result = splatter_add(splatter, splat, 1, error);
    if (result != PS_OK)
        return result;
    splats_read_points(search->render, &sum);
    const double now[3] = {(double)sum.r, (double)sum.g, (double)sum.b};
    const ps_rgb irradiance = {(float)(now[0] - search->before[0]),
                               (float)(now[1] - search->before[1]),
                               (float)(now[2] - search->before[2])};
    for (int i = 0; i < 3; i++)
        search->before[i] = now[i];
    return ps_rgb_maximum(irradiance) > 0 ? add_source(search, photon, irradiance, error) : PS_OK;
}

static ps_result try_photons(struct search *search, const ps_photon *photons, size_t n,
                             struct splat *placed, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t first = 0; first < n && result == PS_OK; first += BATCH) {
        size_t count = n - first < BATCH ? n - first : BATCH;
        photons_place(search->render, photons + first, count, placed);
        for (size_t i = 0; i < count && result == PS_OK; i++)
            result = try_splat(search, &photons[first + i], &placed[i], error);
    }
    return result;
}

static ps_result try_pass(struct search *search, struct splat *placed, struct error *error)
{
    struct render *render = search->render;
    const ps_host *host = own_host(render);
    const ps_photon *photons;
    size_t n = 0;
    ps_result result;
    do {
        result = photon_stream_next(&render->photons, &photons, &n, error);
        if (result == PS_OK)
            result = try_photons(search, photons, n, placed, error);
        search->light->photon_count += n;
        host->progress(host, photon_stream_progress(&render->photons));
        if (result == PS_OK && host->cancelled(host))
            result = error_set(error, PS_CANCELLED, "interrupted");
    } while (result == PS_OK && n > 0);
    return result;
}

static int by_brightness(const void *a, const void *b)
{
    const struct pixel_source *p = a, *q = b;
    float one = ps_luminance(p->irradiance), other = ps_luminance(q->irradiance);
    return one != other ? (one > other ? -1 : 1) : 0;
}

static void look_at_sources(const struct render *render, struct pixel_light *light)
{
    for (size_t i = 0; i < light->source_count; i++) {
        struct pixel_source *source = &light->sources[i];
        if (project_visible(render, source->position, source->normal, &source->x, &source->y))
            source->sight = SEEN;
        else if (camera_project(&render->scene->camera, source->position, &source->x, &source->y))
            source->sight = HIDDEN;
        else
            source->sight = BEHIND_CAMERA;
    }
}

ps_result pixel_light_find(struct render *render, size_t x, size_t y, struct pixel_light *light,
                           struct error *error)
{
    struct search search = {.render = render, .light = light};
    *light = (struct pixel_light){.sources = NULL};
    ps_result result = find_surface(render, x, y, light, error);
    if (result != PS_OK)
        return result;
    struct splat *placed = malloc(BATCH * sizeof *placed);
    if (!placed)
        return error_memory(error, BATCH * sizeof *placed, "splats");
    result = splats_begin_points(render, &light->position, &light->normal, 1, error);
    if (result == PS_OK)
        result = try_pass(&search, placed, error);
    free(placed);
    if (result == PS_OK)
        splats_end_points(render, &light->irradiance);
    else
        splats_drop_points(render);
    if (light->source_count > 0)
        qsort(light->sources, light->source_count, sizeof *light->sources, by_brightness);
    look_at_sources(render, light);
    return result;
}

void pixel_light_release(struct pixel_light *light)
{
    free(light->sources);
    *light = (struct pixel_light){.sources = NULL};
}
