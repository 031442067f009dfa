#include "short_range/short_range_pilot.h"

#include "film/geometry_filter.h"
#include <math.h>

#define PILOT_PART 0.125 /* of the rays */

/* A tile gets some rays in any case, the others by the standard deviation of what single rays find
 * there. */
#define EVEN_SHARE 0.25

static const struct gather_streams numbers = {GATHER_PILOT_DIRECTIONS, GATHER_PILOT_LAMPS};

struct pilot {
    struct gather_rays *rays;
    uint64_t count; /* rays of every step-th pixel */
    uint32_t step;
};

static void keep_every(uint32_t step, ps_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i += step)
        gather_rays_move(points, i, kept++);
    points->count = kept;
}

/* What single rays find, added over the channels. */
struct findings {
    double sum, squares;
};

static void shoot(const struct pilot *pilot, uint64_t tile, const ps_points *points, uint64_t ray,
                  struct findings *findings)
{
    ps_rgb radiance[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS];
    uint32_t targets[PS_TILE_PIXELS];
    uint64_t before = pilot->rays->pass->number * pilot->count;
    for (size_t i = 0; i < points->count; i++)
        indices[i] = ps_sample_block(tile, points->lanes[i]) + before + ray;
    size_t met = gather_rays_shoot(pilot->rays, points, numbers, indices, targets, radiance);
    for (size_t i = 0; i < met; i++) {
        double found = (double)radiance[i].r + (double)radiance[i].g + (double)radiance[i].b;
        findings->sum += found;
        findings->squares += found * found;
    }
}

/* The variance of what single rays find. */
static void shoot_from_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct pilot *pilot = user;
    uint64_t tile = pilot->rays->first_tile + index;
    struct findings findings = {0, 0};
    ps_tile seen;
    ps_points points;
    pilot->rays->host->tile_surfaces(pilot->rays->host, (uint32_t)tile, sizeof seen, &seen);
    ps_collect_points(&seen, &points);
    keep_every(pilot->step, &points);
    for (uint64_t ray = 0; ray < pilot->count; ray++)
        shoot(pilot, tile, &points, ray, &findings);
    double rays = fmax((double)(pilot->count * points.count), 1);
    double mean = findings.sum / rays;
    pilot->rays->near->ray_variances[tile] = (float)fmax(findings.squares / rays - mean * mean, 0);
}

/* Standard deviation, by a tile and those around it, of which each saw few rays. */
static double noise_around(const struct gathered_light *near, uint32_t tiles, uint32_t tile)
{
    uint32_t across = near->gbuffer->picture_across, down = tiles / across;
    uint32_t x = tile % across, y = tile / across;
    double sum = 0, count = 0;
    for (uint32_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < down; v++)
        for (uint32_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < across; u++) {
            sum += (double)near->ray_variances[v * across + u];
            count++;
        }
    return sqrt(sum / count);
}

static void find_noise(struct gathered_light *near, uint32_t tiles)
{
    near->mean_noise = 0;
    for (uint32_t tile = 0; tile < tiles; tile++) {
        near->noises[tile] = (float)noise_around(near, tiles, tile);
        near->mean_noise += (double)near->noises[tile] / tiles;
    }
}

double gather_pilot_share(const struct gathered_light *near, uint64_t tile)
{
    double by_noise = near->mean_noise > 0 ? (double)near->noises[tile] / near->mean_noise : 1;
    return fmin(EVEN_SHARE + (1 - EVEN_SHARE) * by_noise, GATHER_PILOT_LARGEST_SHARE);
}

ps_result gather_pilot(struct gather_rays *rays, double window_rays)
{
    double count =
        PILOT_PART * window_rays / geometry_filter_window(rays->near->radius); /* of a pixel */
    struct pilot pilot = {
        .rays = rays,
        .count = (uint64_t)fmax(count, 1),
        .step = (uint32_t)fmin(fmax(1 / count, 1), PS_TILE_PIXELS - 1) | 1, /* crosses rows */
    };
    uint32_t tiles = gbuffer_picture_tiles(rays->near->gbuffer);
    ps_result result = gather_rays_over_tiles(rays, tiles, shoot_from_tile, &pilot);
    if (result == PS_OK)
        find_noise(rays->near, tiles);
    return result;
}
