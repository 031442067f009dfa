#include "short_range/short_range_light.h"

#include "base/parallel.h"
#include "film/geometry_filter.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* For 400,000 light paths, and how few and many there may be. Furnished rooms want more, empty ones
 * fewer. */
#define RAYS 170
#define LEAST_RAYS 16
#define MOST_RAYS 4096

uint32_t gathered_light_rays(uint64_t paths)
{
    double rays = RAYS * sqrt((double)paths / 4e5);
    return (uint32_t)fmin(fmax(rays, LEAST_RAYS), MOST_RAYS);
}

static size_t lanes_of(const struct gbuffer *gbuffer)
{
    return (size_t)gbuffer->tile_count * PS_TILE_PIXELS;
}

size_t gathered_light_bytes(const struct gbuffer *gbuffer)
{
    size_t of_lane = 2 * sizeof(ps_rgb) + sizeof(float) + sizeof(uint8_t);
    return lanes_of(gbuffer) * of_lane + (size_t)gbuffer_picture_tiles(gbuffer) * 2 * sizeof(float);
}

ps_result gathered_light_begin(struct gathered_light *near, const struct gbuffer *gbuffer,
                               float distance, uint32_t interleave, struct workers *workers,
                               struct error *error)
{
    assert(distance > 0.0f);
    size_t lanes = lanes_of(gbuffer), tiles = gbuffer_picture_tiles(gbuffer);
    near->distance = distance;
    near->gbuffer = gbuffer;
    near->radius = (int)interleave / 2;
    if (!near->averaged)
        near->averaged = malloc(lanes);
    if (!near->found)
        near->found = malloc(lanes * sizeof *near->found);
    if (!near->joined)
        near->joined = malloc(lanes * sizeof *near->joined);
    if (!near->variances)
        near->variances = malloc(lanes * sizeof *near->variances);
    if (!near->ray_variances)
        near->ray_variances = malloc(tiles * sizeof *near->ray_variances);
    if (!near->noises)
        near->noises = malloc(tiles * sizeof *near->noises);
    if (!near->found || !near->joined || !near->variances || !near->averaged ||
        !near->ray_variances || !near->noises)
        return error_memory(error, gathered_light_bytes(gbuffer), "short-range light");
    memset(near->found, 0, lanes * sizeof *near->found);
    struct geometry_filter count = {
        .gbuffer = gbuffer, .radius = near->radius, .counts = near->averaged};
    geometry_filter_apply(&count, workers);
    return PS_OK;
}

void gathered_light_release(struct gathered_light *near)
{
    free(near->found);
    free(near->joined);
    free(near->variances);
    free(near->averaged);
    free(near->ray_variances);
    free(near->noises);
    *near = (struct gathered_light){.found = NULL};
}

/* So many standard deviations may be chance; squared. */
#define CHANCE2 4.0f

/* From the mean of a window to what the pixel found itself, as far as that is no chance
 * (short_range_light.h). */
static ps_rgb between(ps_rgb mean, ps_rgb own, float variance)
{
    ps_rgb apart = {own.r - mean.r, own.g - mean.g, own.b - mean.b};
    float sum = apart.r + apart.g + apart.b, chance = CHANCE2 * variance;
    float part = sum * sum > chance ? 1.0f - chance / (sum * sum) : 0.0f;
    return ps_rgb_add(mean, ps_rgb_scale(apart, part));
}

struct adding {
    struct gbuffer *gbuffer;
    const struct gathered_light *near;
};

static void add_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct adding *adding = user;
    ps_tile *tile = &adding->gbuffer->tiles[index];
    const struct gathered_light *near = adding->near;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        size_t i = index * PS_TILE_PIXELS + lane;
        if (tile->object[lane] == PS_NO_OBJECT)
            continue;
        ps_rgb irradiance = between(near->joined[i], near->found[i], near->variances[i]);
        tile->irradiance_r[lane] += irradiance.r;
        tile->irradiance_g[lane] += irradiance.g;
        tile->irradiance_b[lane] += irradiance.b;
    }
}

void gathered_light_end(struct gathered_light *near, struct gbuffer *gbuffer,
                        struct workers *workers)
{
    if (!(near->distance > 0.0f))
        return;
    struct geometry_filter mean = {
        .gbuffer = gbuffer, .radius = near->radius, .from = near->found, .to = near->joined};
    geometry_filter_apply(&mean, workers);
    struct adding adding = {gbuffer, near};
    parallel_for(workers, gbuffer->tile_count, add_tile, &adding);
}
