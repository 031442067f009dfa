/* light_bvh_build.c: makes a light BVH.
 *
 * From the top: of 12 bins along each axis the split with the least cost of its two halves
 * (light_cluster.h), the surface area heuristic with orientations. A node is split until it has
 * eight children, the costliest child first.
 */
#include "scene/light_bvh_nodes.h"

#include <math.h>
#include <stdlib.h>

#define BINS 12

/* From this depth on nodes are split in the middle, which bounds recursion. */
#define DEEP 32

struct item {
    struct light_cluster cluster;
    uint32_t index; /* light or triangle */
};

static float middle_of(const struct item *item, int axis)
{
    const struct light_cluster *cluster = &item->cluster;
    float low = axis == 0 ? cluster->low.x : axis == 1 ? cluster->low.y : cluster->low.z;
    float high = axis == 0 ? cluster->high.x : axis == 1 ? cluster->high.y : cluster->high.z;
    return 0.5f * low + 0.5f * high;
}

/* How the middles of items spread along an axis. */
struct spread {
    int axis;
    float low, high;
};

static struct spread spread_along(const struct item *items, size_t count, int axis)
{
    struct spread spread = {axis, INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        float middle = middle_of(&items[i], axis);
        spread.low = fminf(spread.low, middle);
        spread.high = fmaxf(spread.high, middle);
    }
    return spread;
}

static int bin_of(const struct spread *spread, const struct item *item)
{
    float place = (middle_of(item, spread->axis) - spread->low) / (spread->high - spread->low);
    int bin = (int)(place * BINS);
    return bin < BINS - 1 ? bin : BINS - 1;
}

/* A split of the items in those of the bins up to `bin` and the others. */
struct split {
    struct spread spread;
    int bin;
    float cost; /* INFINITY: there is none */
};

/* The cost of joining what is in bins on one side, for each side and split. */
static void best_of_axis(const struct item *items, size_t count, const struct spread *spread,
                         struct split *best)
{
    struct light_cluster bins[BINS] = {{.intensity = 0.0f}}, sum = {.intensity = 0.0f};
    float below[BINS];
    if (!(spread->high > spread->low))
        return;
    for (size_t i = 0; i < count; i++) {
        struct light_cluster *bin = &bins[bin_of(spread, &items[i])];
        *bin = light_cluster_join(bin, &items[i].cluster);
    }
    for (int i = 0; i < BINS; i++) {
        sum = light_cluster_join(&sum, &bins[i]);
        below[i] = sum.intensity > 0.0f ? light_cluster_cost(&sum) : 0.0f;
    }
    sum = (struct light_cluster){.intensity = 0.0f};
    for (int i = BINS - 1; i > 0; i--) {
        sum = light_cluster_join(&sum, &bins[i]);
        float cost = below[i - 1] + (sum.intensity > 0.0f ? light_cluster_cost(&sum) : 0.0f);
        if (cost < best->cost)
            *best = (struct split){*spread, i - 1, cost};
    }
}

static void exchange(struct item *a, struct item *b)
{
    struct item kept = *a;
    *a = *b;
    *b = kept;
}

/* Puts the items of the first half in front and returns their number: between 1 and count - 1. */
static size_t split_items(struct item *items, size_t count, uint32_t depth)
{
    struct split best = {.cost = INFINITY};
    for (int axis = 0; axis < 3 && depth < DEEP; axis++) {
        struct spread spread = spread_along(items, count, axis);
        best_of_axis(items, count, &spread, &best);
    }
    if (!(best.cost < INFINITY))
        return count / 2;
    size_t first = 0;
    for (size_t i = 0; i < count; i++)
        if (bin_of(&best.spread, &items[i]) <= best.bin)
            exchange(&items[first++], &items[i]);
    return first > 0 && first < count ? first : count / 2;
}

/* Items that become one child. */
struct group {
    struct item *items;
    size_t count;
    struct light_cluster cluster;
};

static struct group make_group(struct item *items, size_t count)
{
    struct group group = {items, count, {.intensity = 0.0f}};
    for (size_t i = 0; i < count; i++)
        group.cluster = light_cluster_join(&group.cluster, &items[i].cluster);
    return group;
}

/* Splits the items in up to LIGHT_LANES groups, the costliest first; those of at most `smallest`
 * are not split. */
static int make_groups(struct item *items, size_t count, size_t smallest, uint32_t depth,
                       struct group groups[LIGHT_LANES])
{
    int made = 1;
    groups[0] = make_group(items, count);
    while (made < LIGHT_LANES) {
        struct group *costliest = NULL;
        for (int i = 0; i < made; i++)
            if (groups[i].count > smallest &&
                (!costliest ||
                 light_cluster_cost(&groups[i].cluster) > light_cluster_cost(&costliest->cluster)))
                costliest = &groups[i];
        if (!costliest)
            break;
        size_t half = split_items(costliest->items, costliest->count, depth);
        groups[made++] = make_group(costliest->items + half, costliest->count - half);
        *costliest = make_group(costliest->items, half);
    }
    return made;
}

/* A node is being built: of lights, or of the triangles of one. */
struct building {
    struct light_bvh *bvh;
    uint32_t light; /* or NO_LIGHT_ABOVE */
    struct error *error;
};

static ps_result add_node(const struct building *building, uint32_t parent, int lane,
                          uint32_t *index)
{
    struct light_bvh *bvh = building->bvh;
    if (bvh->node_count == bvh->node_room) {
        size_t room = 2 * bvh->node_room + 1;
        struct node *nodes = realloc(bvh->nodes, room * sizeof *nodes);
        if (!nodes)
            return error_memory(building->error, room * sizeof *nodes, "the tree of lights");
        bvh->nodes = nodes;
        bvh->node_room = room;
    }
    *index = (uint32_t)bvh->node_count++;
    bvh->nodes[*index] = (struct node){
        .parent = parent,
        .lane = (uint8_t)lane,
        .light = building->light,
    };
    return PS_OK;
}

static ps_result build(const struct building *building, struct item *items, size_t count,
                       uint32_t parent, int lane, uint32_t depth, uint32_t *index);

/* The node of a split light's triangles. */
static ps_result build_triangles(const struct building *building, uint32_t light, uint32_t parent,
                                 int lane, uint32_t *index)
{
    const struct light *from = &building->bvh->lights[light];
    size_t count = from->surface.mesh.triangle_count, shining = 0;
    struct item *items = malloc(count * sizeof *items);
    if (!items)
        return error_memory(building->error, count * sizeof *items, "the tree of lights");
    for (size_t i = 0; i < count; i++) {
        items[shining] = (struct item){light_bounds_of(from, i), (uint32_t)i};
        shining += items[shining].cluster.intensity > 0.0f;
    }
    const struct building below = {building->bvh, light, building->error};
    ps_result result = build(&below, items, shining, parent, lane, 0, index);
    free(items);
    return result;
}

/* What a group becomes: a light, a few triangles, or a node. */
static ps_result build_child(const struct building *building, const struct group *group,
                             uint32_t parent, int lane, uint32_t depth, struct child *child)
{
    struct light_bvh *bvh = building->bvh;
    uint32_t first = group->items[0].index;
    child->kind = CHILD_NODE;
    if (building->light == NO_LIGHT_ABOVE && group->count == 1) {
        bvh->leaves[first] = (struct leaf){parent, (uint32_t)lane};
        if (light_bvh_is_split(bvh, first))
            return build_triangles(building, first, parent, lane, &child->index);
        *child = (struct child){first, CHILD_LIGHT, 0};
        return PS_OK;
    }
    if (building->light == NO_LIGHT_ABOVE || group->count > LIGHT_BVH_RUN)
        return build(building, group->items, group->count, parent, lane, depth + 1, &child->index);
    *child = (struct child){(uint32_t)bvh->triangle_count, CHILD_TRIANGLES, (uint8_t)group->count};
    for (size_t i = 0; i < group->count; i++)
        bvh->triangles[bvh->triangle_count++] = group->items[i].index;
    return PS_OK;
}

/* What can be drawn of a group. */
static float most_draws(const struct building *building, const struct group *group)
{
    const struct light_bvh *bvh = building->bvh;
    if (building->light != NO_LIGHT_ABOVE)
        return (float)group->count;
    size_t sum = 0;
    for (size_t i = 0; i < group->count; i++) {
        uint32_t light = group->items[i].index;
        sum += light_bvh_is_split(bvh, light) ? bvh->lights[light].surface.mesh.triangle_count : 1;
    }
    return (float)sum;
}

static ps_result build(const struct building *building, struct item *items, size_t count,
                       uint32_t parent, int lane, uint32_t depth, uint32_t *index)
{
    struct group groups[LIGHT_LANES];
    size_t smallest = building->light == NO_LIGHT_ABOVE ? 1 : LIGHT_BVH_RUN;
    int made = make_groups(items, count, smallest, depth, groups);
    ps_result result = add_node(building, parent, lane, index);
    for (int i = 0; i < made && result == PS_OK; i++) {
        struct child child = {0, CHILD_NONE, 0};
        light_lanes_set(&building->bvh->nodes[*index].bounds, i, &groups[i].cluster);
        result = build_child(building, &groups[i], *index, i, depth, &child);
        building->bvh->nodes[*index].children[i] = child;
        building->bvh->nodes[*index].most[i] = most_draws(building, &groups[i]);
    }
    return result;
}

static struct light_cluster bounds_of_light(const struct light *light)
{
    struct light_cluster sum = {.intensity = 0.0f};
    size_t parts = light->emitter == EMITTER_MESH ? light->surface.mesh.triangle_count : 1;
    for (size_t i = 0; i < parts; i++) {
        struct light_cluster part = light_bounds_of(light, i);
        sum = light_cluster_join(&sum, &part);
    }
    return sum;
}

static ps_result build_lights(struct light_bvh *bvh, struct item *items, struct error *error)
{
    for (size_t i = 0; i < bvh->light_count; i++) {
        bvh->leaves[i] = (struct leaf){NO_NODE, 0};
        if (light_is_afar(&bvh->lights[i]))
            continue;
        items[bvh->placed] = (struct item){bounds_of_light(&bvh->lights[i]), (uint32_t)i};
        bvh->placed += items[bvh->placed].cluster.intensity > 0.0f;
    }
    const struct building building = {bvh, NO_LIGHT_ABOVE, error};
    uint32_t root;
    return bvh->placed > 0 ? build(&building, items, bvh->placed, NO_NODE, 0, 0, &root) : PS_OK;
}

static size_t split_triangles(const struct light_bvh *bvh)
{
    size_t sum = 0;
    for (size_t i = 0; i < bvh->light_count; i++)
        sum += light_bvh_is_split(bvh, i) ? bvh->lights[i].surface.mesh.triangle_count : 0;
    return sum;
}

ps_result light_bvh_create(const struct light *lights, size_t count, struct light_bvh **created,
                           struct error *error)
{
    struct light_bvh *bvh = calloc(1, sizeof *bvh);
    if (!bvh)
        return error_memory(error, sizeof *bvh, "the tree of lights");
    *bvh = (struct light_bvh){.lights = lights, .light_count = count};
    size_t triangles = split_triangles(bvh);
    bvh->leaves = malloc((count + 1) * sizeof *bvh->leaves);
    bvh->triangles = malloc((triangles + 1) * sizeof *bvh->triangles);
    struct item *items = malloc((count + 1) * sizeof *items);
    ps_result result = bvh->leaves && bvh->triangles && items
                           ? build_lights(bvh, items, error)
                           : error_memory(error, (count + 1) * sizeof *items, "the tree of lights");
    free(items);
    if (result == PS_OK)
        *created = bvh;
    else
        light_bvh_destroy(bvh);
    return result;
}

void light_bvh_destroy(struct light_bvh *bvh)
{
    if (!bvh)
        return;
    free(bvh->nodes);
    free(bvh->leaves);
    free(bvh->triangles);
    free(bvh);
}

size_t light_bvh_bytes(const struct light_bvh *bvh)
{
    return bvh->node_room * sizeof *bvh->nodes + bvh->light_count * sizeof *bvh->leaves +
           bvh->triangle_count * sizeof *bvh->triangles;
}

size_t light_bvh_count(const struct light_bvh *bvh)
{
    return bvh->placed;
}

bool light_bvh_is_chosen_from(const struct light_bvh *bvh, uint32_t choices)
{
    return bvh->placed > 2 * (size_t)choices;
}

bool light_bvh_is_split(const struct light_bvh *bvh, size_t light)
{
    const struct light *from = &bvh->lights[light];
    return from->emitter == EMITTER_MESH && from->surface.mesh.triangle_count > LIGHT_BVH_TRIANGLES;
}
