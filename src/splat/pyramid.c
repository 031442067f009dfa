#include "splat/pyramid.h"

#include "base/parallel.h"
#include <stdlib.h>

/* Of two nodes no third one is made: to ask it takes as long as to ask one of them. */
#define MOST_ON_TOP 2

size_t pyramid_bytes(const struct pyramid *pyramid)
{
    return pyramid->each * pyramid->subsets * sizeof *pyramid->nodes;
}

ps_result pyramid_create(const struct interleaved *interleaved, struct pyramid *pyramid,
                         struct error *error)
{
    *pyramid = (struct pyramid){
        .subsets = interleaved->subsets,
        .tiles_across = interleaved->tiles_across,
        .tiles_down = interleaved->tiles_down,
    };
    uint32_t across = interleaved->tiles_across, down = interleaved->tiles_down;
    do {
        across = (across + PYRAMID_GROUP - 1) / PYRAMID_GROUP;
        down = (down + PYRAMID_GROUP - 1) / PYRAMID_GROUP;
        int level = pyramid->levels++;
        pyramid->first[level] = pyramid->each;
        pyramid->across[level] = across;
        pyramid->down[level] = down;
        pyramid->each += (size_t)across * down;
    } while (pyramid->levels < PYRAMID_LEVELS && across * down > MOST_ON_TOP);
    size_t bytes = pyramid_bytes(pyramid);
    pyramid->nodes = aligned_alloc(64, bytes);
    return pyramid->nodes ? PS_OK : error_memory(error, bytes, "tile bounds");
}

void pyramid_release(struct pyramid *pyramid)
{
    free(pyramid->nodes);
    *pyramid = (struct pyramid){.levels = 0};
}

struct build {
    struct pyramid *pyramid;
    const struct interleaved *interleaved;
};

static void grow(const struct bounds *bounds, uint32_t i, struct bound *bound)
{
    if (!(bounds->center_x[i] < BOUNDS_NOWHERE))
        return;
    struct bound other = {
        {bounds->center_x[i] - bounds->extent_x[i], bounds->center_y[i] - bounds->extent_y[i],
         bounds->center_z[i] - bounds->extent_z[i]},
        {bounds->center_x[i] + bounds->extent_x[i], bounds->center_y[i] + bounds->extent_y[i],
         bounds->center_z[i] + bounds->extent_z[i]},
        {bounds->normal_low_x[i], bounds->normal_low_y[i], bounds->normal_low_z[i]},
        {bounds->normal_high_x[i], bounds->normal_high_y[i], bounds->normal_high_z[i]},
    };
    bound_add(bound, &other);
}

static struct bound bound_all(const struct bounds *bounds)
{
    struct bound bound = bound_empty();
    for (uint32_t i = 0; i < BOUNDS_WIDTH; i++)
        grow(bounds, i, &bound);
    return bound;
}

/* What lies below a node: the blocks of a tile, or a node of the next level. */
static const struct bounds *children_of(const struct build *build, uint32_t subset, int level,
                                        uint32_t column, uint32_t row)
{
    const struct pyramid *pyramid = build->pyramid;
    uint32_t across = level == 0 ? pyramid->tiles_across : pyramid->across[level - 1];
    uint32_t down = level == 0 ? pyramid->tiles_down : pyramid->down[level - 1];
    if (column >= across || row >= down)
        return NULL;
    size_t place = (size_t)row * across + column;
    if (level == 0)
        return &build->interleaved->tiles[(size_t)subset * across * down + place].blocks;
    return &pyramid->nodes[subset * pyramid->each + pyramid->first[level - 1] + place];
}

static void build_node(const struct build *build, uint32_t subset, int level, uint32_t column,
                       uint32_t row)
{
    struct pyramid *pyramid = build->pyramid;
    struct bounds *node = &pyramid->nodes[subset * pyramid->each + pyramid->first[level] +
                                          (size_t)row * pyramid->across[level] + column];
    for (uint32_t i = 0; i < BOUNDS_WIDTH; i++) {
        const struct bounds *children =
            children_of(build, subset, level, column * PYRAMID_GROUP + i % PYRAMID_GROUP,
                        row * PYRAMID_GROUP + i / PYRAMID_GROUP);
        struct bound bound = children ? bound_all(children) : bound_empty();
        bounds_set(node, i, &bound);
    }
}

static void build_subset(void *user, uint64_t subset, uint32_t worker)
{
    (void)worker;
    const struct build *build = user;
    const struct pyramid *pyramid = build->pyramid;
    for (int level = 0; level < pyramid->levels; level++)
        for (uint32_t row = 0; row < pyramid->down[level]; row++)
            for (uint32_t column = 0; column < pyramid->across[level]; column++)
                build_node(build, (uint32_t)subset, level, column, row);
}

void pyramid_build(struct pyramid *pyramid, const struct interleaved *interleaved,
                   struct workers *workers)
{
    struct build build = {pyramid, interleaved};
    parallel_for(workers, interleaved->subsets, build_subset, &build);
}

struct walk {
    const struct pyramid *pyramid;
    const struct kernel_variant *kernel;
    const struct kernel_splat *splat;
    pyramid_visitor visitor;
    void *user;
};

static bool walk_node(const struct walk *walk, int level, uint32_t column, uint32_t row)
{
    const struct pyramid *pyramid = walk->pyramid;
    uint32_t subset = walk->splat->subset;
    const struct bounds *node = &pyramid->nodes[subset * pyramid->each + pyramid->first[level] +
                                                (size_t)row * pyramid->across[level] + column];
    uint32_t mask = walk->kernel->touch(node, walk->splat);
    for (uint32_t i = 0; mask >> i; i++) {
        if (!(mask >> i & 1u))
            continue;
        uint32_t x = column * PYRAMID_GROUP + i % PYRAMID_GROUP;
        uint32_t y = row * PYRAMID_GROUP + i / PYRAMID_GROUP;
        uint32_t tile = (subset * pyramid->tiles_down + y) * pyramid->tiles_across + x;
        bool on = level == 0 ? walk->visitor(walk->user, tile) : walk_node(walk, level - 1, x, y);
        if (!on)
            return false;
    }
    return true;
}

bool pyramid_visit(const struct pyramid *pyramid, const struct kernel_variant *kernel,
                   const struct kernel_splat *splat, pyramid_visitor visitor, void *user)
{
    struct walk walk = {pyramid, kernel, splat, visitor, user};
    int top = pyramid->levels - 1;
    for (uint32_t row = 0; row < pyramid->down[top]; row++)
        for (uint32_t column = 0; column < pyramid->across[top]; column++)
            if (!walk_node(&walk, top, column, row))
                return false;
    return true;
}
