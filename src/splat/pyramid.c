/* pyramid.c: bounds of the tiles and of groups of 4x4 of them (see bin.h). */
#include "splat/bin.h"

#include "base/parallel.h"
#include <psplat/math.h>
#include <stdlib.h>

static const struct pyramid_node nothing = {
    .extent = {-1, -1, -1},
};

ps_result pyramid_create(const struct gbuffer *gbuffer, struct pyramid *pyramid,
                         struct error *error)
{
    *pyramid = (struct pyramid){.levels = 0};
    uint32_t across = gbuffer->tiles_across, down = gbuffer->tiles_down;
    size_t count = 0;
    for (;;) {
        int level = pyramid->levels++;
        pyramid->first[level] = count;
        pyramid->across[level] = across;
        pyramid->down[level] = down;
        count += (size_t)across * down;
        if ((across == 1 && down == 1) || pyramid->levels == PYRAMID_LEVELS)
            break;
        across = (across + PYRAMID_GROUP - 1) / PYRAMID_GROUP;
        down = (down + PYRAMID_GROUP - 1) / PYRAMID_GROUP;
    }
    pyramid->nodes = malloc(count * sizeof *pyramid->nodes);
    return pyramid->nodes ? PS_OK
                          : error_memory(error, count * sizeof *pyramid->nodes, "tile bounds");
}

void pyramid_release(struct pyramid *pyramid)
{
    free(pyramid->nodes);
    *pyramid = (struct pyramid){.levels = 0};
}

static ps_vec3 minimum(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)};
}

static ps_vec3 maximum(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){fmaxf(a.x, b.x), fmaxf(a.y, b.y), fmaxf(a.z, b.z)};
}

struct bounds {
    ps_vec3 low, high, normal_low, normal_high;
};

static const struct bounds empty_bounds = {
    {INFINITY, INFINITY, INFINITY},
    {-INFINITY, -INFINITY, -INFINITY},
    {INFINITY, INFINITY, INFINITY},
    {-INFINITY, -INFINITY, -INFINITY},
};

static struct pyramid_node node_of(const struct bounds *bounds)
{
    if (!(bounds->low.x <= bounds->high.x))
        return nothing;
    return (struct pyramid_node){
        .center = ps_scale(ps_add(bounds->low, bounds->high), 0.5f),
        .extent = ps_scale(ps_subtract(bounds->high, bounds->low), 0.5f),
        .normal_low = bounds->normal_low,
        .normal_high = bounds->normal_high,
    };
}

struct build {
    struct pyramid *pyramid;
    const struct gbuffer *gbuffer;
};

static void bound_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct build *build = user;
    const ps_tile *tile = &build->gbuffer->tiles[index];
    struct bounds bounds = empty_bounds;
    for (int i = 0; i < PS_TILE_PIXELS; i++) {
        if (tile->object[i] == PS_NO_OBJECT)
            continue;
        ps_vec3 p = {tile->position_x[i], tile->position_y[i], tile->position_z[i]};
        ps_vec3 n = {tile->normal_x[i], tile->normal_y[i], tile->normal_z[i]};
        bounds.low = minimum(bounds.low, p);
        bounds.high = maximum(bounds.high, p);
        bounds.normal_low = minimum(bounds.normal_low, n);
        bounds.normal_high = maximum(bounds.normal_high, n);
    }
    build->pyramid->nodes[index] = node_of(&bounds);
}

static void bound_group(struct pyramid *pyramid, int level, uint32_t column, uint32_t row)
{
    const struct pyramid_node *children = pyramid->nodes + pyramid->first[level - 1];
    struct bounds bounds = empty_bounds;
    for (uint32_t y = row * PYRAMID_GROUP;
         y < (row + 1) * PYRAMID_GROUP && y < pyramid->down[level - 1]; y++)
        for (uint32_t x = column * PYRAMID_GROUP;
             x < (column + 1) * PYRAMID_GROUP && x < pyramid->across[level - 1]; x++) {
            const struct pyramid_node *child = &children[y * pyramid->across[level - 1] + x];
            if (child->extent.x < 0)
                continue;
            bounds.low = minimum(bounds.low, ps_subtract(child->center, child->extent));
            bounds.high = maximum(bounds.high, ps_add(child->center, child->extent));
            bounds.normal_low = minimum(bounds.normal_low, child->normal_low);
            bounds.normal_high = maximum(bounds.normal_high, child->normal_high);
        }
    uint32_t index = row * pyramid->across[level] + column;
    pyramid->nodes[pyramid->first[level] + index] = node_of(&bounds);
}

void pyramid_build(struct pyramid *pyramid, const struct gbuffer *gbuffer, uint32_t threads)
{
    struct build build = {pyramid, gbuffer};
    parallel_for(threads, gbuffer->tile_count, bound_tile, &build);
    for (int level = 1; level < pyramid->levels; level++)
        for (uint32_t row = 0; row < pyramid->down[level]; row++)
            for (uint32_t column = 0; column < pyramid->across[level]; column++)
                bound_group(pyramid, level, column, row);
}
