/* light_bvh.c: draws lights from a light BVH; see light_bvh.h. */
#include "scene/light_bvh_nodes.h"
#include "scene/light_kinds.h"

/* A point that asks, and the line of its draws: place i lies at i + u. */
struct draw {
    const struct light_bvh *bvh;
    ps_vec3 position, normal;
    double u;
};

/* A node and its part of the line, with the places from `first` to before `end`. */
struct part {
    uint32_t node;
    double low, high;
    int32_t first, end;
};

/* The number of the first place that does not lie below `at`, which is above -1. */
static inline int32_t place_from(const struct draw *draw, double at)
{
    double number = at - draw->u;
    int32_t whole = (int32_t)number;
    return whole + ((double)whole < number);
}

/* Cuts off the front of a part, which has the first `below` of `sum` shares; `low`: where that before ended. */
static inline struct part cut_part(const struct draw *draw, const struct part *part, double low,
                                   int32_t first, float below, float sum)
{
    struct part front = {0, low, part->high, first, part->end};
    if (below < sum) {
        front.high = part->low + (part->high - part->low) * (double)(below / sum);
        front.end = place_from(draw, front.high);
    }
    return front;
}

/* How often a choice was drawn over how often it is in the mean. */
static inline float weight_of(const struct part *part)
{
    return (float)((double)(part->end - part->first) / (part->high - part->low));
}

/* Triangles share their part of the line by their area. */
static size_t choose_triangles(const struct draw *draw, uint32_t light, const struct child *run,
                               const struct part *part, struct light_choice *choices)
{
    const struct light_surface *surface = &draw->bvh->lights[light].surface;
    const uint32_t *triangles = &draw->bvh->triangles[run->index];
    float areas[LIGHT_BVH_RUN], sum = 0.0f, below = 0.0f;
    struct part own = {0, part->low, part->low, part->first, part->first};
    size_t count = 0;
    for (uint32_t i = 0; i < run->run; i++)
        sum += areas[i] = light_surface_triangle_area(surface, triangles[i]);
    for (uint32_t i = 0; i < run->run && own.end < part->end; i++) {
        below += areas[i];
        own = cut_part(draw, part, own.high, own.end, below, sum);
        if (own.first < own.end)
            choices[count++] = (struct light_choice){light, triangles[i], weight_of(&own)};
    }
    return count;
}

/* What is drawn, and what is still to be looked into. Each entry has a place at least, so there are no more than places. */
struct drawn {
    struct light_choice *choices;
    size_t count;
    struct part stack[MOST_LIGHT_CHOICES];
    size_t depth;
};

/* Looks into a child that has some of the places. */
static inline void choose_child(const struct draw *draw, const struct node *node, int lane,
                                struct part *part, struct drawn *drawn)
{
    const struct child *child = &node->children[lane];
    part->node = child->index;
    if (child->kind == CHILD_NODE)
        drawn->stack[drawn->depth++] = *part;
    else if (child->kind == CHILD_LIGHT)
        drawn->choices[drawn->count++] =
            (struct light_choice){child->index, WHOLE_LIGHT, weight_of(part)};
    else
        drawn->count +=
            choose_triangles(draw, node->light, child, part, drawn->choices + drawn->count);
}

/* Looks into the children of a node, which share its part of the line by importance. */
static void choose_children(const struct draw *draw, const struct part *part, struct drawn *drawn)
{
    const struct node *node = &draw->bvh->nodes[part->node];
    float importance[LIGHT_LANES], sum = 0.0f, below = 0.0f;
    struct part own = {0, part->low, part->low, part->first, part->first};
    light_lanes_importance(&node->bounds, draw->position, draw->normal, importance);
    for (int i = 0; i < LIGHT_LANES; i++)
        sum += importance[i];
    for (int i = 0; i < LIGHT_LANES && own.end < part->end && sum > 0.0f; i++) {
        if (!(importance[i] > 0.0f))
            continue;
        below += importance[i];
        own = cut_part(draw, part, own.high, own.end, below, sum);
        if (own.first < own.end)
            choose_child(draw, node, i, &own, drawn);
    }
}

/* What is drawn below a node, which has the whole line. */
static size_t choose_below(const struct draw *draw, uint32_t root, uint32_t number,
                           struct light_choice *choices)
{
    struct drawn drawn;
    drawn.choices = choices;
    drawn.count = 0;
    drawn.depth = 1;
    drawn.stack[0] = (struct part){root, 0.0, (double)number, 0, (int32_t)number};
    while (drawn.depth > 0) {
        struct part part = drawn.stack[--drawn.depth];
        choose_children(draw, &part, &drawn);
    }
    return drawn.count;
}

size_t light_bvh_choose(const struct light_bvh *bvh, ps_vec3 position, ps_vec3 normal,
                        uint32_t number, double u, struct light_choice *choices)
{
    const struct draw draw = {bvh, position, normal, u};
    return bvh->placed > 0 ? choose_below(&draw, 0, number, choices) : 0;
}

bool light_bvh_choose_triangle(const struct light_bvh *bvh, size_t light, ps_vec3 position,
                               ps_vec3 normal, double u, struct light_choice *choice)
{
    const struct draw draw = {bvh, position, normal, u};
    const struct leaf *leaf = &bvh->leaves[light];
    return leaf->node != NO_NODE &&
           choose_below(&draw, bvh->nodes[leaf->node].children[leaf->lane].index, 1, choice) == 1;
}

float light_bvh_expected(const struct light_bvh *bvh, size_t light, ps_vec3 position,
                         uint32_t number)
{
    static const ps_vec3 none = {0, 0, 0};
    float expected = (float)number;
    struct leaf leaf = bvh->leaves[light];
    if (leaf.node == NO_NODE)
        return 0.0f;
    while (leaf.node != NO_NODE) {
        const struct node *node = &bvh->nodes[leaf.node];
        float importance[LIGHT_LANES], sum = 0.0f;
        light_lanes_importance(&node->bounds, position, none, importance);
        for (int i = 0; i < LIGHT_LANES; i++)
            sum += importance[i];
        expected *= sum > 0.0f ? importance[leaf.lane] / sum : 0.0f;
        leaf = (struct leaf){node->parent, node->lane};
    }
    return expected;
}
