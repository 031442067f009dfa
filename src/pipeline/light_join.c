#include "pipeline/light_join.h"

#include "base/parallel.h"
#include <psplat/tile.h>

#define REACH 2 /* pixels to each side */

/* Cosine between normals of what counts as flat: 3.6 degrees. */
#define LEAST_COSINE 0.998f

/* A pixel: its place in arrays of lanes, and its surface. */
struct pixel {
    size_t index;
    ps_vec3 position, normal;
};

static bool find_pixel(const struct gbuffer *gbuffer, int64_t x, int64_t y, struct pixel *pixel)
{
    uint32_t tile, lane;
    if (!gbuffer_find(gbuffer, x, y, &tile, &lane))
        return false;
    *pixel = (struct pixel){
        .index = (size_t)tile * PS_TILE_PIXELS + lane,
        .position = ps_tile_position(&gbuffer->tiles[tile], lane),
        .normal = ps_tile_normal(&gbuffer->tiles[tile], lane),
    };
    return true;
}

static bool alike(const struct gbuffer *gbuffer, const struct pixel *a, const struct pixel *b)
{
    float cosine = ps_dot(a->normal, b->normal);
    ps_vec3 apart = ps_subtract(b->position, a->position);
    return gbuffer_met_alike(gbuffer->met[a->index], gbuffer->met[b->index]) &&
           cosine > LEAST_COSINE &&
           gbuffer_same_surface(cosine, ps_dot(a->normal, apart), ps_dot(apart, apart));
}

static ps_rgb mean_around(const struct gbuffer *gbuffer, const struct pixel *here, uint32_t x,
                          uint32_t y)
{
    ps_rgb sum = gbuffer->direct[here->index];
    float count = 1.0f;
    for (int dy = 0; dy <= REACH; dy++)
        for (int dx = dy == 0 ? 1 : -REACH; dx <= REACH; dx++) {
            struct pixel there, opposite;
            if (!find_pixel(gbuffer, (int64_t)x + dx, (int64_t)y + dy, &there) ||
                !find_pixel(gbuffer, (int64_t)x - dx, (int64_t)y - dy, &opposite) ||
                !alike(gbuffer, here, &there) || !alike(gbuffer, here, &opposite))
                continue;
            sum = ps_rgb_add(sum, gbuffer->direct[there.index]);
            sum = ps_rgb_add(sum, gbuffer->direct[opposite.index]);
            count += 2.0f;
        }
    return ps_rgb_scale(sum, 1.0f / count);
}

static void join_tile(void *user, uint64_t tile, uint32_t worker)
{
    (void)worker;
    const struct gbuffer *gbuffer = user;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        struct pixel here;
        if (gbuffer_pixel(gbuffer, (uint32_t)tile, lane, &x, &y) &&
            find_pixel(gbuffer, x, y, &here))
            gbuffer->joined[here.index] = mean_around(gbuffer, &here, x, y);
    }
}

void light_join(struct gbuffer *gbuffer, uint32_t threads)
{
    parallel_for(threads, gbuffer->tile_count, join_tile, gbuffer);
    ps_rgb *found = gbuffer->direct;
    gbuffer->direct = gbuffer->joined;
    gbuffer->joined = found;
}
