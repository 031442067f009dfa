#include "pipeline/near_gather.h"

#include "film/pair_mean.h"
#include "splat/near_share.h"
#include <math.h>
#include <psplat/tile.h>

/* Rays of each pixel that tell whether anything is near to the block that it lies in. Where none of the
 * block's sixteen pixels meet anything, less than half a percent of the light can come from nearby. */
#define SCOUTS 4

#define BLOCK 4 /* pixels along the side of a block */
#define BLOCKS (PS_TILE_PIXELS / (BLOCK * BLOCK))

/* Sets of random numbers: for directions, and for points on lamps. */
#define DIRECTION_SET 1u
#define LAMP_SET 2u
#define PILOT_DIRECTION_SET 3u
#define PILOT_LAMP_SET 4u

/* A part of the rays goes ahead as a pilot, which tells how many each tile gets: some in any case, the others by
 * the standard deviation of what single rays find there. */
#define PILOT_PART 0.125
#define EVEN_SHARE 0.25
#define LARGEST_SHARE 16.0

#define TILES_AT_A_TIME 256 /* until the user may stop */

struct gathering {
    const ps_host *host;
    const ps_pass *pass;
    struct near_light *near;
    double rays; /* of a pixel in the middle of a surface and those that it is averaged with */
    uint64_t pilot_rays; /* of every pilot_step-th pixel */
    uint32_t pilot_step;
    uint64_t first_tile; /* of those that are at work */
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

/* Rays of a pixel, by its tile's share of them. Those of its window are averaged, n of them in the middle of a
 * surface and c along its rim, where a ray tells c pixels and not n: what noise is left in the picture is least
 * with sqrt(n / c) times as many there. A power of two, since these are spread most evenly. */
static uint64_t rays_of(const struct gathering *work, uint64_t tile, uint32_t lane)
{
    double averaged = work->near->averaged[tile * PS_TILE_PIXELS + lane];
    double rays = (double)work->near->shares[tile] * work->rays;
    return power_of_two(rays / sqrt(pair_mean_window(work->near->reach) * averaged));
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
    uint64_t before = work->pass->number * BLOCK * BLOCK * power_of_two(LARGEST_SHARE * work->rays);
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
        uint64_t run = ps_sample_block(tile, BLOCK * BLOCK * block);
        samples->first[lane] = run + before + place * most[block];
    }
}

/* Shoots one ray from each point, and moves what they meet to the front; returns how many. targets[i]: the
 * point of hit i. */
static size_t look(const struct gathering *work, const ps_points *points, uint32_t set,
                   const uint64_t *indices, ps_ray *rays, ps_hit *hits, uint32_t *targets)
{
    float numbers[PS_TILE_PIXELS][4];
    size_t met = 0;
    work->host->samples(work->host, PS_STREAM_PATH, set, indices, points->count, numbers);
    for (uint32_t i = 0; i < points->count; i++) {
        ps_vec3 normal = points->normals[i];
        rays[i] = ps_leave_surface(points->positions[i], normal,
                                   ps_cosine_direction(normal, numbers[i][0], numbers[i][1]),
                                   work->pass->surface_offset);
        rays[i].tfar = work->near->distance;
        targets[i] = i;
    }
    work->host->intersect(work->host, rays, points->count, hits);
    ps_forget_own_surface(points, targets, points->count, work->pass->surface_offset, hits);
    for (uint32_t i = 0; i < points->count; i++) {
        if (!(hits[i].distance < INFINITY))
            continue;
        targets[met] = i;
        rays[met] = rays[i];
        hits[met] = hits[i];
        hits[met++].flags &= ~PS_HIT_SPECULAR; /* gloss is splatted */
    }
    return met;
}

/* What one ray of each point finds of the light that splats leave out: radiance[i] comes to point targets[i], for
 * i < what is returned. */
static size_t find(const struct gathering *work, const ps_points *points, const uint32_t sets[2],
                   uint64_t *indices, uint32_t *targets, ps_rgb *radiance)
{
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    size_t met = look(work, points, sets[0], indices, rays, hits, targets);
    for (size_t i = 0; i < met; i++)
        indices[i] = indices[targets[i]]; /* targets[i] >= i */
    work->host->direct_radiance(work->host, rays, hits, PS_STREAM_PATH, sets[1], indices, met,
                                radiance);
    struct near_share share = near_share_until(work->near->distance);
    for (size_t i = 0; i < met; i++) {
        float left = 1.0f - near_share_of_splats(share, hits[i].distance);
        radiance[i] = ps_rgb_scale(radiance[i], left);
    }
    return met;
}

/* Adds what one ray of each point finds; near[block] becomes 1 where it meets something. With directions
 * drawn by the cosine, a ray's irradiance is pi times the radiance that it finds. */
static void gather(const struct gathering *work, const struct sample_runs *samples,
                   const ps_points *points, uint64_t tile, uint64_t sample, uint8_t *near)
{
    static const uint32_t sets[2] = {DIRECTION_SET, LAMP_SET};
    ps_rgb *irradiance = &work->near->found[tile * PS_TILE_PIXELS];
    float *variances = &work->near->variances[tile * PS_TILE_PIXELS];
    ps_rgb radiance[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS];
    uint32_t targets[PS_TILE_PIXELS];
    for (size_t i = 0; i < points->count; i++)
        indices[i] = samples->first[points->lanes[i]] + sample;
    size_t met = find(work, points, sets, indices, targets, radiance);
    for (size_t i = 0; i < met; i++) {
        uint32_t lane = points->lanes[targets[i]];
        ps_rgb found = ps_rgb_scale(radiance[i], PS_PI / (float)samples->rays[lane]);
        float sum = found.r + found.g + found.b;
        irradiance[lane] = ps_rgb_add(irradiance[lane], found);
        variances[lane] += sum * sum;
        near[block_of(lane)] = 1;
    }
}

static void move_point(ps_points *points, size_t from, size_t to)
{
    points->positions[to] = points->positions[from];
    points->normals[to] = points->normals[from];
    points->lanes[to] = points->lanes[from];
}

/* Keeps the points that shoot ray `sample`: of those whose scouts are back, the ones of blocks that something
 * is near to. */
static void keep_looking(const struct sample_runs *samples, uint64_t sample, const uint8_t *near,
                         ps_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        if (sample >= samples->rays[lane] || (sample >= SCOUTS && !near[block_of(lane)]))
            continue;
        move_point(points, i, kept++);
    }
    points->count = kept;
}

/* Standard deviation, by a tile and those around it, of which each saw few of the pilot's rays. */
static double noise_around(const struct near_light *near, uint32_t tiles, uint32_t tile)
{
    uint32_t across = near->tiles_across, down = tiles / across;
    uint32_t x = tile % across, y = tile / across;
    double sum = 0, count = 0;
    for (uint32_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < down; v++)
        for (uint32_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < across; u++) {
            sum += (double)near->ray_variances[v * across + u];
            count++;
        }
    return sqrt(sum / count);
}

/* What rays of the tiles around tell of the variance of what pixels will find. Their own add to it: all of a
 * pixel's may meet nothing bright by chance, or one of them what few meet. */
static void expect_variances(const struct gathering *work, uint64_t tile, const ps_points *points,
                             const struct sample_runs *samples)
{
    double noise = (double)PS_PI * noise_around(work->near, work->pass->tile_count, (uint32_t)tile);
    float *variances = &work->near->variances[tile * PS_TILE_PIXELS];
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        variances[lane] = (float)(noise * noise / (double)samples->rays[lane]);
    }
}

static void gather_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct gathering *work = user;
    const ps_host *host = work->host;
    uint64_t tile = work->first_tile + index;
    ps_points points;
    struct sample_runs samples;
    uint8_t near[BLOCKS] = {0};
    ps_collect_points(host->tile(host, (uint32_t)tile), &points);
    share_samples(work, tile, &points, &samples);
    expect_variances(work, tile, &points, &samples);
    for (uint64_t sample = 0; sample < samples.most && points.count > 0; sample++) {
        keep_looking(&samples, sample, near, &points);
        gather(work, &samples, &points, tile, sample, near);
    }
}

static void keep_every(uint32_t step, ps_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i += step)
        move_point(points, i, kept++);
    points->count = kept;
}

/* What single rays find, added over the channels. */
struct findings {
    double sum, squares;
};

static void shoot_pilot(const struct gathering *work, uint64_t tile, const ps_points *points,
                        uint64_t ray, struct findings *findings)
{
    static const uint32_t sets[2] = {PILOT_DIRECTION_SET, PILOT_LAMP_SET};
    ps_rgb radiance[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS];
    uint32_t targets[PS_TILE_PIXELS];
    uint64_t before = work->pass->number * work->pilot_rays;
    for (size_t i = 0; i < points->count; i++)
        indices[i] = ps_sample_block(tile, points->lanes[i]) + before + ray;
    size_t met = find(work, points, sets, indices, targets, radiance);
    for (size_t i = 0; i < met; i++) {
        double found = (double)radiance[i].r + (double)radiance[i].g + (double)radiance[i].b;
        findings->sum += found;
        findings->squares += found * found;
    }
}

/* The variance of what single rays find. Their light does not count: where they happen to find more than there
 * is, more rays follow, so that the mean of all of them would be too small. */
static void pilot_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct gathering *work = user;
    uint64_t tile = work->first_tile + index;
    struct findings findings = {0, 0};
    ps_points points;
    ps_collect_points(work->host->tile(work->host, (uint32_t)tile), &points);
    keep_every(work->pilot_step, &points);
    for (uint64_t ray = 0; ray < work->pilot_rays; ray++)
        shoot_pilot(work, tile, &points, ray, &findings);
    double rays = fmax((double)(work->pilot_rays * points.count), 1);
    double mean = findings.sum / rays;
    work->near->ray_variances[tile] = (float)fmax(findings.squares / rays - mean * mean, 0);
}

/* Shares of 1 on average, or a little less where one is cut off. */
static void share_rays(struct near_light *near, uint32_t tiles)
{
    double mean = 0;
    for (uint32_t tile = 0; tile < tiles; tile++) {
        double noise = noise_around(near, tiles, tile);
        near->shares[tile] = (float)noise;
        mean += noise / tiles;
    }
    for (uint32_t tile = 0; tile < tiles; tile++) {
        double by_noise = mean > 0 ? (double)near->shares[tile] / mean : 1;
        double share = EVEN_SHARE + (1 - EVEN_SHARE) * by_noise;
        near->shares[tile] = (float)fmin(share, LARGEST_SHARE);
    }
}

static ps_result over_tiles(struct gathering *work, ps_body body)
{
    uint64_t tiles = work->pass->tile_count;
    for (work->first_tile = 0; work->first_tile < tiles; work->first_tile += TILES_AT_A_TIME) {
        uint64_t left = tiles - work->first_tile;
        if (work->host->cancelled(work->host))
            return PS_CANCELLED;
        work->host->parallel_for(work->host, left < TILES_AT_A_TIME ? left : TILES_AT_A_TIME, body,
                                 work);
    }
    return PS_OK;
}

ps_result near_gather(const ps_host *host, const ps_pass *pass, struct near_light *near,
                      double rays)
{
    double pilot = PILOT_PART * rays / pair_mean_window(near->reach); /* rays of a pixel */
    struct gathering work = {
        .host = host,
        .pass = pass,
        .near = near,
        .rays = rays,
        .pilot_rays = (uint64_t)fmax(pilot, 1),
        .pilot_step = (uint32_t)fmin(fmax(1 / pilot, 1), PS_TILE_PIXELS - 1) | 1, /* crosses rows */
    };
    ps_result result = over_tiles(&work, pilot_tile);
    if (result != PS_OK)
        return result;
    share_rays(near, pass->tile_count);
    return over_tiles(&work, gather_tile);
}
