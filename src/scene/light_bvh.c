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

/* Cuts shares down to `most`, and gives what is cut to the others, as long as that makes shares too
 * large. */
static void limit_shares(const float *importance, const float *most, int count, double length,
                         double *shares)
{
    bool cut = true;
    while (cut) {
        double left = length, sum = 0.0;
        cut = false;
        for (int i = 0; i < count; i++) {
            bool full = shares[i] >= (double)most[i];
            left -= full ? (double)most[i] : 0.0;
            sum += full ? 0.0 : (double)importance[i];
        }
        for (int i = 0; i < count; i++) {
            if (shares[i] >= (double)most[i]) {
                shares[i] = (double)most[i];
            } else if (importance[i] > 0.0f) {
                shares[i] = (double)importance[i] * (left / sum);
                cut |= shares[i] >= (double)most[i];
            }
        }
    }
}

/* Shares `length` among children by importance, but no child gets more than it has lights: what is
 * above that goes to the others. What none of them can take is left. */
static inline void share_length(const float *importance, const float *most, int count,
                                double length, double *shares)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += (double)importance[i];
    double scale = sum > 0.0 ? length / sum : 0.0;
    for (int i = 0; i < count; i++)
        shares[i] = (double)importance[i] * scale;
    if (length > 1.0)
        limit_shares(importance, most, count, length, shares);
}

/* The front of what is left of a part, of a length: it begins where the child before it ended. */
static inline struct part next_part(const struct draw *draw, const struct part *part,
                                    const struct part *before, double length)
{
    struct part next = {0, before->high, before->high + length, before->end, 0};
    next.end = place_from(draw, next.high);
    if (next.end > part->end)
        next.end = part->end;
    return next;
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
    static const float most[LIGHT_BVH_RUN] = {1.0f, 1.0f, 1.0f, 1.0f};
    const struct light_surface *surface = &draw->bvh->lights[light].surface;
    const uint32_t *triangles = &draw->bvh->triangles[run->index];
    float areas[LIGHT_BVH_RUN];
    double shares[LIGHT_BVH_RUN];
    struct part own = {0, part->low, part->low, part->first, part->first};
    size_t count = 0;
    for (uint32_t i = 0; i < run->run; i++)
        areas[i] = light_surface_triangle_area(surface, triangles[i]);
    share_length(areas, most, run->run, part->high - part->low, shares);
    for (uint32_t i = 0; i < run->run && own.end < part->end; i++) {
        own = next_part(draw, part, &own, shares[i]);
        if (own.first < own.end)
            choices[count++] = (struct light_choice){light, triangles[i], weight_of(&own)};
    }
    return count;
}

/* What is drawn, and what is still to be looked into. Each entry has a place at least, so there are
 * no more than places. */
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
static void choose_children(const struct draw *draw, const struct part *part,
                            const float importance[LIGHT_LANES], struct drawn *drawn)
{
    const struct node *node = &draw->bvh->nodes[part->node];
    double shares[LIGHT_LANES];
    struct part own = {0, part->low, part->low, part->first, part->first};
    share_length(importance, node->most, LIGHT_LANES, part->high - part->low, shares);
    for (int i = 0; i < LIGHT_LANES && own.end < part->end; i++) {
        own = next_part(draw, part, &own, shares[i]);
        if (own.first < own.end)
            choose_child(draw, node, i, &own, drawn);
    }
}

static void weigh_children(const struct draw *draw, uint32_t node, float importance[LIGHT_LANES])
{
    light_lanes_importance(&draw->bvh->nodes[node].bounds, draw->position, draw->normal,
                           importance);
}

/* What is drawn below a node whose children have this importance, which has the whole line. */
static size_t choose_below(const struct draw *draw, uint32_t root, double length,
                           float importance[LIGHT_LANES], struct light_choice *choices)
{
    struct drawn drawn;
    struct part part = {root, 0.0, length, 0, place_from(draw, length)};
    drawn.choices = choices;
    drawn.count = 0;
    drawn.depth = 0;
    if (part.end == 0)
        return 0;
    choose_children(draw, &part, importance, &drawn);
    while (drawn.depth > 0) {
        part = drawn.stack[--drawn.depth];
        weigh_children(draw, part.node, importance);
        choose_children(draw, &part, importance, &drawn);
    }
    return drawn.count;
}

/* The length of the line, by what the root's children give. */
static double length_of_line(const struct light_bvh *bvh, const struct light_draws *draws,
                             const float importance[LIGHT_LANES])
{
    double most = (double)draws->most, worth = 0.0;
    if (!(draws->threshold > 0.0f))
        return most;
    for (int i = 0; i < LIGHT_LANES; i++)
        worth +=
            fmin((double)importance[i] / (double)draws->threshold, (double)bvh->nodes[0].most[i]);
    return worth < most ? worth : most;
}

size_t light_bvh_choose(const struct light_bvh *bvh, ps_vec3 position, ps_vec3 normal,
                        const struct light_draws *draws, double u, struct light_choice *choices)
{
    const struct draw draw = {bvh, position, normal, u};
    float importance[LIGHT_LANES];
    if (bvh->placed == 0)
        return 0;
    weigh_children(&draw, 0, importance);
    double length = length_of_line(bvh, draws, importance);
    return draws->all && length >= (double)draws->most
               ? LIGHT_BVH_ALL
               : choose_below(&draw, 0, length, importance, choices);
}

bool light_bvh_choose_triangle(const struct light_bvh *bvh, size_t light, ps_vec3 position,
                               ps_vec3 normal, double u, struct light_choice *choice)
{
    const struct draw draw = {bvh, position, normal, u};
    const struct leaf *leaf = &bvh->leaves[light];
    float importance[LIGHT_LANES];
    if (leaf->node == NO_NODE)
        return false;
    uint32_t root = bvh->nodes[leaf->node].children[leaf->lane].index;
    weigh_children(&draw, root, importance);
    return choose_below(&draw, root, 1.0, importance, choice) == 1;
}

/* The part that a child of a node has of the line of a point. */
static double length_of(const struct draw *draw, const struct leaf *leaf, double line)
{
    if (leaf->node == NO_NODE)
        return line;
    const struct node *node = &draw->bvh->nodes[leaf->node];
    const struct leaf above = {node->parent, node->lane};
    float importance[LIGHT_LANES];
    double shares[LIGHT_LANES];
    weigh_children(draw, leaf->node, importance);
    share_length(importance, node->most, LIGHT_LANES, length_of(draw, &above, line), shares);
    return shares[leaf->lane];
}

float light_bvh_expected(const struct light_bvh *bvh, size_t light, ps_vec3 position,
                         const struct light_draws *draws)
{
    const struct draw draw = {bvh, position, {0, 0, 0}, 0.0};
    const struct leaf *leaf = &bvh->leaves[light];
    float importance[LIGHT_LANES];
    if (leaf->node == NO_NODE)
        return 0.0f;
    weigh_children(&draw, 0, importance);
    double line = length_of_line(bvh, draws, importance);
    return draws->all && line >= (double)draws->most ? 1.0f : (float)length_of(&draw, leaf, line);
}

/* Lists the lights below a node from `lights` on; returns where the list ends. */
static uint32_t *list_below(const struct light_bvh *bvh, uint32_t index, uint32_t *lights)
{
    const struct node *node = &bvh->nodes[index];
    for (int i = 0; i < LIGHT_LANES; i++) {
        const struct child *child = &node->children[i];
        if (child->kind == CHILD_LIGHT)
            *lights++ = child->index;
        else if (child->kind == CHILD_NODE && bvh->nodes[child->index].light != NO_LIGHT_ABOVE)
            *lights++ = bvh->nodes[child->index].light;
        else if (child->kind == CHILD_NODE)
            lights = list_below(bvh, child->index, lights);
    }
    return lights;
}

size_t light_bvh_list(const struct light_bvh *bvh, uint32_t *lights)
{
    return bvh->placed > 0 ? (size_t)(list_below(bvh, 0, lights) - lights) : 0;
}
