#include "splat/exact.h"

#include <psplat/math.h>

/* The pixels of a tile that lie inside a splat's box and face its light. */
struct inside {
    size_t count;
    uint32_t lanes[PS_TILE_PIXELS];
    float weight[PS_TILE_PIXELS], cosine[PS_TILE_PIXELS]; /* 0: the light is not splatted */
    ps_vec3 points[PS_TILE_PIXELS];                       /* off their surfaces */
};

static ps_vec3 normal_of(const struct field_tile *tile, uint32_t lane)
{
    return (ps_vec3){tile->normal_x[lane], tile->normal_y[lane], tile->normal_z[lane]};
}

static ps_vec3 position_of(const struct field_tile *tile, uint32_t lane)
{
    return (ps_vec3){tile->position_x[lane], tile->position_y[lane], tile->position_z[lane]};
}

/* What the walls beside a splat make of its weight at (u, v): 0 behind one of them. */
static float make_up(const struct kernel_splat *splat, const struct kernel_profile *profile,
                     float u, float v, float width)
{
    float beyond[PS_MOST_WALLS] = {0.0f, 0.0f};
    for (uint32_t k = 0; k < splat->wall_count; k++) {
        beyond[k] = kernel_beyond(&splat->walls[k], profile->beyond, u, v, 1.0f / width);
        if (beyond[k] >= KERNEL_BEHIND)
            return 0.0f;
    }
    return 1.0f / kernel_left(beyond[0], beyond[1], splat->walls_likeness);
}

/* At (u, v), of which the pixel takes a part so wide. */
static float weight_at(const struct kernel_splat *splat, const struct kernel_profile *profile,
                       float u, float v, float width)
{
    float r2 = ps_min((u * u + v * v) / (width * width), 0.99999f);
    size_t entry = (size_t)(r2 * (float)KERNEL_PROFILE_SIZE);
    float narrowing = 1.0f + splat->by_width * (1.0f / (width * width) - 1.0f);
    return profile->weights[entry] * splat->kernel_scale * narrowing *
           make_up(splat, profile, u, v, width);
}

static void collect(const struct field_tile *tile, const struct kernel_splat *splat,
                    float surface_offset, const struct kernel_profile *profile,
                    struct inside *inside)
{
    inside->count = 0;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        ps_vec3 position = position_of(tile, lane);
        ps_vec3 d = ps_subtract(position, splat->centre);
        float u = ps_dot(d, splat->u), v = ps_dot(d, splat->v), t = ps_dot(d, splat->w);
        float r2 = u * u + v * v;
        if (!(r2 < 1.0f && t >= splat->near_depth && t <= splat->far_depth))
            continue;
        ps_vec3 normal = normal_of(tile, lane);
        float cosine = -ps_dot(normal, splat->w);
        if (!(cosine > 0.0f))
            continue;
        float above = kernel_above(splat, u, v, t);
        float width = width_at(&splat->width, above, cosine, ps_dot(normal, splat->u),
                               ps_dot(normal, splat->v));
        if (!(r2 < width * width && above >= splat->clearance * ps_min(width, 1.0f)))
            continue;
        size_t i = inside->count++;
        inside->lanes[i] = lane;
        inside->weight[i] = weight_at(splat, profile, u, v, width);
        inside->cosine[i] = above >= splat->nearest ? cosine : 0.0f;
        inside->points[i] = ps_add_scaled(position, surface_offset, normal);
    }
}

static void add(struct field_tile *tile, uint32_t lane, ps_rgb power, float weight, float cosine)
{
    float projected = weight * cosine;
    tile->irradiance_r[lane] += projected * power.r;
    tile->irradiance_g[lane] += projected * power.g;
    tile->irradiance_b[lane] += projected * power.b;
    tile->weight[lane] += weight;
}

struct kernel_count exact_accumulate(struct field_tile *tile, const struct exact_test *test,
                                     const ps_splat *splats, const struct kernel_splat *prepared,
                                     const uint32_t *indices, size_t n,
                                     const struct kernel_profile *profile)
{
    struct kernel_count count = {0, 0};
    struct inside inside;
    uint8_t lit[PS_TILE_PIXELS];
    for (size_t i = 0; i < n; i++) {
        const struct kernel_splat *splat = &prepared[indices[i]];
        collect(tile, splat, test->surface_offset, profile, &inside);
        if (inside.count == 0)
            continue;
        test->vtable->visible(test->state, test->host, &splats[indices[i]], inside.points,
                              inside.count, lit);
        count.tests += inside.count;
        for (size_t k = 0; k < inside.count; k++)
            if (lit[k]) {
                add(tile, inside.lanes[k], splat->power, inside.weight[k], inside.cosine[k]);
                count.lit++;
            }
    }
    return count;
}
