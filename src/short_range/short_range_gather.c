#include "short_range/short_range_gather.h"

#include "film/geometry_filter.h"
#include "short_range/short_range_pilot.h"
#include <math.h>

/* Rays of each pixel that tell whether anything is near to the block that it lies in. Where none of
 * the block's sixteen pixels meet anything, less than half a percent of the light can come from
 * nearby. */
#define SCOUTS 4

#define BLOCK 4 /* pixels along the side of a block */
#define BLOCKS (PS_TILE_PIXELS / (BLOCK * BLOCK))

static const struct gather_streams numbers = {GATHER_DIRECTIONS, GATHER_LAMPS};

struct gathering {
    struct gather_rays rays;
    /* Of a pixel in the middle of a surface and those that it is averaged with. */
    double window_rays;
};

static uint32_t block_of(uint32_t lane)
{
    return lane / PS_TILE_SIZE / BLOCK * (PS_TILE_SIZE / BLOCK) + lane % PS_TILE_SIZE / BLOCK;
}

static uint64_t power_of_two(double number)
{
    uint64_t power = 1;
    while (sqrt(2) * (double)power < number)
        power *= 2;
    return power;
}

/* Rays of a pixel, by its tile's share of them. Those of its window are averaged, n of them in the
 * middle of a surface and c along its rim, where a ray tells c pixels and not n: what noise is left
 * in the picture is least with sqrt(n / c) times as many there. A power of two, since these are
 * spread most evenly. */
static uint64_t rays_of(const struct gathering *work, uint64_t tile, uint32_t lane)
{
    const struct gathered_light *near = work->rays.near;
    double averaged = near->averaged[tile * PS_TILE_PIXELS + lane];
    double rays =
        gather_pilot_share(near, gbuffer_number(near->gbuffer, (uint32_t)tile)) * work->window_rays;
    return power_of_two(rays / sqrt(geometry_filter_window(near->radius) * averaged));
}

/* The samples of a tile's pixels, and where those of a pixel begin. */
struct sample_runs {
    uint64_t most; /* rays of any pixel */
    uint64_t rays[PS_TILE_PIXELS], first[PS_TILE_PIXELS];
};

/* The sixteen pixels of a block share one run of the sequence, since what they find is averaged. */
static void share_samples(const struct gathering *work, uint64_t tile, const ps_points *points,
                          struct sample_runs *samples)
{
    uint64_t most[BLOCKS] = {0};
    uint64_t largest = power_of_two(GATHER_PILOT_LARGEST_SHARE * work->window_rays);
    uint64_t before = work->rays.pass->number * BLOCK * BLOCK * largest;
    samples->most = 0;
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        uint64_t rays = samples->rays[lane] = rays_of(work, tile, lane);
        most[block_of(lane)] = rays > most[block_of(lane)] ? rays : most[block_of(lane)];
        samples->most = rays > samples->most ? rays : samples->most;
    }
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i], block = block_of(lane);
        uint64_t place = lane / PS_TILE_SIZE % BLOCK * BLOCK + lane % BLOCK;
        uint64_t number = gbuffer_number(work->rays.near->gbuffer, (uint32_t)tile);
        uint64_t run = ps_sample_block(number, BLOCK * BLOCK * block);
        samples->first[lane] = run + before + place * most[block];
    }
}

/* Adds what one ray of each point finds; near[block] becomes 1 where it meets something. With
 * directions drawn by the cosine, a ray's irradiance is pi times the radiance that it finds. */
static void gather(const struct gathering *work, const struct sample_runs *samples,
                   const ps_points *points, uint64_t tile, uint64_t sample, uint8_t *near)
{
    ps_rgb *irradiance = &work->rays.near->found[tile * PS_TILE_PIXELS];
    float *variances = &work->rays.near->variances[tile * PS_TILE_PIXELS];
    ps_rgb radiance[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS];
    uint32_t targets[PS_TILE_PIXELS];
    for (size_t i = 0; i < points->count; i++)
        indices[i] = samples->first[points->lanes[i]] + sample;
    size_t met = gather_rays_shoot(&work->rays, points, numbers, indices, targets, radiance);
    for (size_t i = 0; i < met; i++) {
        uint32_t lane = points->lanes[targets[i]];
        ps_rgb found = ps_rgb_scale(radiance[i], PS_PI / (float)samples->rays[lane]);
        float sum = found.r + found.g + found.b;
        irradiance[lane] = ps_rgb_add(irradiance[lane], found);
        variances[lane] += sum * sum;
        near[block_of(lane)] = 1;
    }
}

/* Keeps the points that shoot ray `sample`: of those whose scouts are back, the ones of blocks that
 * something is near to. */
static void keep_looking(const struct sample_runs *samples, uint64_t sample, const uint8_t *near,
                         ps_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        if (sample >= samples->rays[lane] || (sample >= SCOUTS && !near[block_of(lane)]))
            continue;
        gather_rays_move(points, i, kept++);
    }
    points->count = kept;
}

/* What rays of the tiles around tell of the variance of what pixels will find. Their own add to it:
 * all of a pixel's may meet nothing bright by chance, or one of them what few meet. */
static void expect_variances(const struct gathering *work, uint64_t tile, const ps_points *points,
                             const struct sample_runs *samples)
{
    const struct gathered_light *near = work->rays.near;
    double noise =
        (double)PS_PI * (double)near->noises[gbuffer_number(near->gbuffer, (uint32_t)tile)];
    float *variances = &near->variances[tile * PS_TILE_PIXELS];
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        variances[lane] = (float)(noise * noise / (double)samples->rays[lane]);
    }
}

static void gather_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct gathering *work = user;
    uint64_t tile = work->rays.first_tile + index;
    ps_points points;
    struct sample_runs samples;
    uint8_t near[BLOCKS] = {0};
    ps_collect_points(&work->rays.near->gbuffer->tiles[tile], &points);
    share_samples(work, tile, &points, &samples);
    expect_variances(work, tile, &points, &samples);
    for (uint64_t sample = 0; sample < samples.most && points.count > 0; sample++) {
        keep_looking(&samples, sample, near, &points);
        gather(work, &samples, &points, tile, sample, near);
    }
}

ps_result short_range_gather(const ps_host *host, const ps_pass *pass, struct gathered_light *near,
                             double rays)
{
    struct gathering work = {{host, pass, near, 0}, rays};
    ps_result result = gather_pilot(&work.rays, rays);
    if (result != PS_OK)
        return result;
    return gather_rays_over_tiles(&work.rays, near->gbuffer->tile_count, gather_tile, &work);
}
