#include "splat/exact.h"

#include <psplat/math.h>

/* Where a splat's pixels are, off their surfaces. */
static void collect_points(const struct interleaved_tile *tile, const uint32_t *lanes, uint32_t n,
                           float surface_offset, ps_vec3 *points)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t lane = lanes[i];
        ps_vec3 position = {tile->position_x[lane], tile->position_y[lane], tile->position_z[lane]};
        ps_vec3 normal = {tile->normal_x[lane], tile->normal_y[lane], tile->normal_z[lane]};
        if (tile->geometric)
            normal = (ps_vec3){tile->geometric->x[lane], tile->geometric->y[lane],
                               tile->geometric->z[lane]};
        points[i] = ps_add_scaled(position, surface_offset, normal);
    }
}

static void add(struct interleaved_tile *tile, uint32_t lane, ps_rgb power, float weight,
                float projected)
{
    tile->irradiance_r[lane] += projected * power.r;
    tile->irradiance_g[lane] += projected * power.g;
    tile->irradiance_b[lane] += projected * power.b;
    tile->weight[lane] += weight;
}

struct kernel_count exact_accumulate(struct interleaved_tile *tile, const struct exact_test *test,
                                     const struct splat *splats,
                                     const struct kernel_splat *prepared, const uint32_t *indices,
                                     size_t n, const struct kernel_profile *profile)
{
    struct kernel_count count = {0, 0};
    struct kernel_weighed weighed;
    ps_vec3 points[PS_TILE_PIXELS];
    uint8_t lit[PS_TILE_PIXELS];
    for (size_t i = 0; i < n; i++) {
        const struct kernel_splat *splat = &prepared[indices[i]];
        uint32_t pixels = test->kernel->weigh(tile, splat, profile, &weighed);
        if (pixels == 0)
            continue;
        collect_points(tile, weighed.lanes, pixels, test->surface_offset, points);
        test->vtable->visible(test->state, test->host, &splats[indices[i]].bundle, points, pixels,
                              lit);
        count.tests += pixels;
        for (uint32_t k = 0; k < pixels; k++)
            if (lit[k]) {
                add(tile, weighed.lanes[k], splat->power, weighed.weight[k], weighed.projected[k]);
                count.lit++;
            }
    }
    return count;
}
