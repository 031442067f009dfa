#include "light_tree.h"

#include <stdbool.h>

#define DIMENSIONS 6
/* What a unit of direction counts as, in radii of the scene: as much as half of the scene between
 * opposite walls. */
#define DIRECTION_SCALE 0.5f

/* --- building --- */

/* Lights from which on the build of a cluster may be cancelled. */
#define LONG_BUILD 100000

struct building {
    const ps_pass *pass;
    const struct light_tree *tree;
    float direction_scale;
};

static float coordinate(const struct building *building, uint32_t light, int dimension)
{
    const ps_photon *photon = &building->tree->lights->lights[light];
    const ps_vec3 v = dimension < 3 ? photon->position : photon->normal;
    float value = dimension % 3 == 0 ? v.x : dimension % 3 == 1 ? v.y : v.z;
    return dimension < 3 ? value : value * building->direction_scale;
}

static int widest_dimension(const struct building *building, const uint32_t *order, size_t count)
{
    float widest = -1.0f;
    int best = 0;
    for (int dimension = 0; dimension < DIMENSIONS; dimension++) {
        float low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < count; i++) {
            float value = coordinate(building, order[i], dimension);
            low = ps_min(low, value);
            high = ps_max(high, value);
        }
        if (high - low > widest) {
            widest = high - low;
            best = dimension;
        }
    }
    return best;
}

static void exchange(uint32_t *a, uint32_t *b)
{
    uint32_t kept = *a;
    *a = *b;
    *b = kept;
}

/* Puts the lights with the smallest `half` coordinates first (quickselect, Hoare 1961). */
static void select_half(const struct building *building, int dimension, uint32_t *order,
                        size_t count, size_t half)
{
    size_t first = 0, last = count - 1;
    while (first < last) {
        float pivot = coordinate(building, order[first + (last - first) / 2], dimension);
        size_t left = first, right = last;
        for (;;) {
            while (coordinate(building, order[left], dimension) < pivot)
                left++;
            while (coordinate(building, order[right], dimension) > pivot)
                right--;
            if (left >= right)
                break;
            exchange(&order[left++], &order[right--]);
        }
        if (half <= right)
            last = right;
        else
            first = right + 1;
    }
}

/* Of the points that the lights' rays end at, for a bound that holds. */
static void find_extent(const struct building *building, const uint32_t *order, size_t count,
                        struct light_cluster *cluster)
{
    const struct virtual_lights *lights = building->tree->lights;
    ps_vec3 sum = {0, 0, 0};
    cluster->low = cluster->high = virtual_light_origin(building->pass, &lights->lights[order[0]]);
    for (size_t i = 0; i < count; i++) {
        const ps_photon *light = &lights->lights[order[i]];
        ps_vec3 p = virtual_light_origin(building->pass, light);
        ps_vec3 low = cluster->low, high = cluster->high;
        cluster->low = (ps_vec3){ps_min(low.x, p.x), ps_min(low.y, p.y), ps_min(low.z, p.z)};
        cluster->high = (ps_vec3){ps_max(high.x, p.x), ps_max(high.y, p.y), ps_max(high.z, p.z)};
        sum = ps_add_scaled(sum, 1.0f, light->normal);
    }
    float length = ps_length(sum);
    cluster->axis = length > 0.0f ? ps_scale(sum, 1.0f / length) : lights->lights[order[0]].normal;
    cluster->cosine = 1.0f;
    for (size_t i = 0; i < count; i++)
        cluster->cosine =
            ps_min(cluster->cosine, ps_dot(cluster->axis, lights->lights[order[i]].normal));
}

/* The representative of one of the children, by their power. The numbers of a cluster and of its
 * children are from different sets: those of one set are stratified, which would tie the two draws
 * to each other. */
static void find_representative(const struct building *building, size_t place, uint32_t depth)
{
    struct light_cluster *clusters = building->tree->clusters, *cluster = &clusters[place];
    const struct light_cluster *left = cluster + 1, *right = &clusters[cluster->right];
    const ps_host *host = building->tree->host;
    uint64_t index = (uint64_t)building->pass->number << 40 | place;
    float numbers[1][4];
    float of_left = ps_luminance(left->power), of_right = ps_luminance(right->power);
    host->samples(host, PS_STREAM_ESTIMATOR, VIRTUAL_LIGHTS_SETS + depth, &index, 1, numbers);
    int is_left = numbers[0][0] * (of_left + of_right) < of_left;
    cluster->representative = (is_left ? left : right)->representative;
    cluster->power = ps_rgb_add(left->power, right->power);
}

static void build_cluster(const struct building *building, size_t place, uint32_t depth,
                          uint32_t *order, size_t count)
{
    const struct light_tree *tree = building->tree;
    struct light_cluster *cluster = &tree->clusters[place];
    find_extent(building, order, count, cluster);
    cluster->right = 0;
    cluster->representative = order[0];
    cluster->power = tree->lights->lights[order[0]].power;
    if (count == 1 || (count > LONG_BUILD && tree->host->cancelled(tree->host)))
        return;
    size_t half = count / 2;
    select_half(building, widest_dimension(building, order, count), order, count, half);
    cluster->right = (uint32_t)(place + 2 * half);
    build_cluster(building, place + 1, depth + 1, order, half);
    build_cluster(building, place + 2 * half, depth + 1, order + half, count - half);
    find_representative(building, place, depth);
}

ps_result light_tree_build(const ps_host *host, const ps_pass *pass,
                           const struct virtual_lights *lights, struct light_tree *tree)
{
    ps_vec3 center;
    float radius;
    size_t count = lights->count;
    host->scene_bounds(host, &center, &radius);
    *tree = (struct light_tree){
        .host = host,
        .lights = lights,
        .clusters = host->allocate(host, 2 * count * sizeof *tree->clusters, "virtual lights"),
    };
    uint32_t *order = host->allocate(host, count * sizeof *order, "virtual lights");
    if (tree->clusters && order) {
        const struct building building = {pass, tree, DIRECTION_SCALE * radius};
        for (size_t i = 0; i < count; i++)
            order[i] = (uint32_t)i;
        build_cluster(&building, 0, 0, order, count);
    }
    bool failed = !tree->clusters || !order;
    host->release(host, order);
    return failed ? PS_ERROR_MEMORY : host->cancelled(host) ? PS_CANCELLED : PS_OK;
}

void light_tree_release(struct light_tree *tree)
{
    tree->host->release(tree->host, tree->clusters);
    *tree = (struct light_tree){.host = tree->host};
}

/* --- bounds --- */

/* The cosine of an angle that is smaller by another one, given both cosines; 1 where nothing is
 * left of it. */
static float reduce_angle(float cosine, float by)
{
    if (cosine >= by)
        return 1.0f;
    float sines = ps_max(1.0f - cosine * cosine, 0.0f) * ps_max(1.0f - by * by, 0.0f);
    return cosine * by + sqrtf(sines);
}

static float reach(ps_vec3 half, ps_vec3 axis)
{
    return fabsf(axis.x) * half.x + fabsf(axis.y) * half.y + fabsf(axis.z) * half.z;
}

float light_cluster_bound(const struct light_cluster *cluster, ps_vec3 point, ps_vec3 normal,
                          float clamp)
{
    ps_vec3 half = ps_scale(ps_subtract(cluster->high, cluster->low), 0.5f);
    ps_vec3 center = ps_subtract(ps_add_scaled(cluster->low, 1.0f, half), point);
    float above = ps_dot(center, normal), beneath = -ps_dot(center, cluster->axis);
    if (above + reach(half, normal) <= 0.0f)
        return 0.0f;
    ps_vec3 outside = {ps_max(fabsf(center.x) - half.x, 0.0f),
                       ps_max(fabsf(center.y) - half.y, 0.0f),
                       ps_max(fabsf(center.z) - half.z, 0.0f)};
    float distance2 = ps_max(ps_dot(outside, outside), clamp * clamp);
    float center2 = ps_dot(center, center), radius2 = ps_dot(half, half);
    if (center2 <= radius2)
        return 1.0f / distance2;
    float inverse = 1.0f / sqrtf(center2), cone = sqrtf(1.0f - radius2 / center2);
    float receiver = reduce_angle(above * inverse, cone);
    float light = reduce_angle(reduce_angle(beneath * inverse, cone), cluster->cosine);
    return light > 0.0f ? receiver * light / distance2 : 0.0f;
}
