#include "film/pair_mean.h"

#include "base/parallel.h"

/* Cosine between normals of what counts as flat: 3.6 degrees. */
#define LEAST_COSINE 0.998f

/* A pixel of the G-buffer, and its place in arrays of lanes. */
struct pixel {
    const ps_tile *tile;
    uint32_t lane;
    size_t index;
};

static struct pixel pixel_at(const struct gbuffer *gbuffer, uint32_t tile, uint32_t lane)
{
    return (struct pixel){&gbuffer->tiles[tile], lane, (size_t)tile * PS_TILE_PIXELS + lane};
}

static bool alike(const struct pair_mean *mean, const struct pixel *a, const struct pixel *b)
{
    if (mean->met && !gbuffer_met_alike(mean->met[a->index], mean->met[b->index]))
        return false;
    struct gbuffer_offset offset = gbuffer_offset_of(a->tile, a->lane, b->tile, b->lane);
    return offset.cosine > LEAST_COSINE &&
           gbuffer_same_surface(offset.cosine, offset.off_plane, offset.distance2);
}

/* A neighbour that counts, if it has an opposite one. */
static bool find_alike(const struct pair_mean *mean, const struct pixel *here, int64_t x, int64_t y,
                       struct pixel *there)
{
    uint32_t tile, lane;
    if (!gbuffer_find(mean->gbuffer, x, y, &tile, &lane))
        return false;
    *there = pixel_at(mean->gbuffer, tile, lane);
    return alike(mean, here, there);
}

static ps_rgb mean_around(const struct pair_mean *mean, const struct pixel *here, uint32_t x,
                          uint32_t y)
{
    ps_rgb sum = mean->from[here->index];
    float count = 1.0f;
    int reach = mean->reach;
    for (int dy = 0; dy <= reach; dy++)
        for (int dx = dy == 0 ? 1 : -reach; dx <= reach; dx++) {
            struct pixel there, opposite;
            if (!find_alike(mean, here, (int64_t)x + dx, (int64_t)y + dy, &there) ||
                !find_alike(mean, here, (int64_t)x - dx, (int64_t)y - dy, &opposite))
                continue;
            sum = ps_rgb_add(sum, mean->from[there.index]);
            sum = ps_rgb_add(sum, mean->from[opposite.index]);
            count += 2.0f;
        }
    return ps_rgb_scale(sum, 1.0f / count);
}

static void mean_of_tile(void *user, uint64_t tile, uint32_t worker)
{
    (void)worker;
    const struct pair_mean *mean = user;
    const struct gbuffer *gbuffer = mean->gbuffer;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        if (!gbuffer_pixel(gbuffer, (uint32_t)tile, lane, &x, &y))
            continue;
        struct pixel here = pixel_at(gbuffer, (uint32_t)tile, lane);
        mean->to[here.index] = mean_around(mean, &here, x, y);
    }
}

void pair_mean_take(struct pair_mean *mean, uint32_t threads)
{
    parallel_for(threads, mean->gbuffer->tile_count, mean_of_tile, mean);
}
