#include "compensation.h"

/* Weighs what rays met by the share of its light that lights leave out. */
static void weigh_hits(float clamp, struct paths *paths, const struct paths_segment *segment)
{
    for (size_t i = 0; i < paths->count; i++) {
        float distance = segment->hits[i].distance / clamp;
        float left_out = ps_max(1.0f - distance * distance, 0.0f);
        paths->throughput[i] = ps_rgb_scale(paths->throughput[i], left_out);
    }
}

/* One ray from each point, which becomes a path at a surface close by. That surface reflects
 * diffusely alone, as virtual lights shine: no caustics from it, and no lobe but PS_DIFFUSE. */
static void trace_sample(const void *user, const ps_points *points, const uint64_t *samples,
                         ps_rgb *sums)
{
    const struct compensation *compensation = user;
    const struct paths_setting *setting = &compensation->paths;
    struct paths paths;
    struct paths_segment segment;
    paths_start(setting, points, samples, compensation->clamp, &paths, &segment);
    paths_intersect(setting, points, 1, &paths, &segment);
    paths_drop_lost(&paths, &segment);
    weigh_hits(compensation->clamp, &paths, &segment);
    paths_draw_numbers(setting, 2, samples, &paths, &segment);
    paths_add_direct_without_caustics(setting, 1, &paths, NULL, &segment, sums);
    paths_scatter_all(setting, 1u << PS_DIFFUSE, &paths, &segment);
    paths_follow(setting, points, samples, 2, &paths, &segment, sums);
}

void compensation_add(const struct compensation *compensation, uint64_t tile,
                      const ps_points *points, ps_rgb *irradiance)
{
    ps_rgb left_out[PS_TILE_PIXELS];
    if (compensation->rays == 0 || !(compensation->clamp > 0.0f))
        return;
    paths_average(&compensation->paths, tile, points, compensation->rays, trace_sample,
                  compensation, left_out);
    for (size_t i = 0; i < points->count; i++)
        irradiance[i] = ps_rgb_add(irradiance[i], left_out[i]);
}
