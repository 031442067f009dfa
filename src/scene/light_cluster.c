#include "scene/light_cluster.h"

#include <psplat/isa.h>
#include <psplat/math.h>

static float safe_acos(float cosine)
{
    return acosf(fminf(fmaxf(cosine, -1.0f), 1.0f));
}

static ps_vec3 lower(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){ps_min(a.x, b.x), ps_min(a.y, b.y), ps_min(a.z, b.z)};
}

static ps_vec3 upper(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){ps_max(a.x, b.x), ps_max(a.y, b.y), ps_max(a.z, b.z)};
}

/* --- joining --- */

/* The smallest cone around two; -1: all directions. */
static float join_cones(const struct light_cluster *a, const struct light_cluster *b, ps_vec3 *axis)
{
    float theta_a = safe_acos(a->cos_theta_o), theta_b = safe_acos(b->cos_theta_o);
    float between = safe_acos(ps_dot(a->axis, b->axis));
    *axis = a->axis;
    if (fminf(between + theta_b, PS_PI) <= theta_a)
        return a->cos_theta_o;
    if (fminf(between + theta_a, PS_PI) <= theta_b) {
        *axis = b->axis;
        return b->cos_theta_o;
    }
    float theta = 0.5f * (theta_a + between + theta_b), turn = theta - theta_a;
    ps_vec3 aside = ps_add_scaled(b->axis, -ps_dot(a->axis, b->axis), a->axis);
    float length = ps_length(aside);
    if (theta >= PS_PI || !(length > 0.0f))
        return -1.0f;
    ps_vec3 turned = ps_scale(a->axis, cosf(turn));
    *axis = ps_normalize(ps_add_scaled(turned, sinf(turn) / length, aside));
    return cosf(theta);
}

struct light_cluster light_cluster_join(const struct light_cluster *a,
                                        const struct light_cluster *b)
{
    if (!(b->intensity > 0.0f))
        return *a;
    if (!(a->intensity > 0.0f))
        return *b;
    struct light_cluster joined = {
        .low = lower(a->low, b->low),
        .high = upper(a->high, b->high),
        .cos_theta_e = ps_min(a->cos_theta_e, b->cos_theta_e),
        .intensity = a->intensity + b->intensity,
        .both_sides = a->both_sides || b->both_sides,
    };
    joined.cos_theta_o = join_cones(a, b, &joined.axis);
    return joined;
}

/* --- importance --- */

/* No light is nearer than the root of the first, nor more important than the second. */
#define NEAREST2 1e-30f
#define MOST_IMPORTANT 1e30f

void light_lanes_set(struct light_lanes *lanes, int lane, const struct light_cluster *cluster)
{
    ps_vec3 half = ps_scale(ps_subtract(cluster->high, cluster->low), 0.5f);
    ps_vec3 middle = ps_add(cluster->low, half);
    float cosine = cluster->cos_theta_o;
    lanes->x[lane] = middle.x;
    lanes->y[lane] = middle.y;
    lanes->z[lane] = middle.z;
    lanes->radius[lane] = ps_length(half);
    lanes->axis_x[lane] = cluster->axis.x;
    lanes->axis_y[lane] = cluster->axis.y;
    lanes->axis_z[lane] = cluster->axis.z;
    lanes->cos_theta_o[lane] = cosine > -1.0f ? cosine : -2.0f; /* less than any, however rounded */
    lanes->sin_theta_o[lane] = sqrtf(ps_max(1.0f - cosine * cosine, 0.0f));
    lanes->cos_theta_e[lane] = cluster->cos_theta_e;
    lanes->back[lane] = cluster->both_sides ? -1.0f : 1.0f;
    lanes->intensity[lane] = cluster->intensity;
}

/* The cosine of an angle that is smaller by another one; 1 where nothing is left of it. */
static PS_INLINED float reduce_angle(float cosine, float by_cosine, float by_sine)
{
    float sine = sqrtf(ps_max(1.0f - cosine * cosine, 0.0f));
    float reduced = cosine * by_cosine + sine * by_sine;
    return cosine >= by_cosine ? 1.0f : reduced;
}

PS_EVERY_ISA static void importance_of(const struct light_lanes *lanes, ps_vec3 position,
                                       ps_vec3 normal, float importance[LIGHT_LANES])
{
    float anywhere = ps_dot(normal, normal) > 0.0f ? 0.0f : 1.0f; /* without a normal */
#pragma omp simd
    for (int i = 0; i < LIGHT_LANES; i++) {
        float x = lanes->x[i] - position.x, y = lanes->y[i] - position.y;
        float z = lanes->z[i] - position.z, radius = lanes->radius[i];
        float distance2 = x * x + y * y + z * z;
        float inverse = 1.0f / sqrtf(ps_max(distance2, NEAREST2));
        float sin_b = ps_min(radius * inverse, 1.0f), cos_b = sqrtf(1.0f - sin_b * sin_b);
        float along =
            -(x * lanes->axis_x[i] + y * lanes->axis_y[i] + z * lanes->axis_z[i]) * inverse;
        float leaving = reduce_angle(ps_max(along, along * lanes->back[i]), cos_b, sin_b);
        leaving = reduce_angle(leaving, lanes->cos_theta_o[i], lanes->sin_theta_o[i]);
        leaving = leaving < lanes->cos_theta_e[i] ? 0.0f : leaving;
        float above = (x * normal.x + y * normal.y + z * normal.z) * inverse;
        float arriving = ps_max(ps_max(reduce_angle(above, cos_b, sin_b), 0.0f), anywhere);
        bool inside = distance2 <= radius * radius;
        float cosines = inside ? 1.0f : leaving * arriving;
        float nearest2 = ps_max(ps_max(distance2, 0.25f * radius * radius), NEAREST2);
        importance[i] = ps_min(cosines * lanes->intensity[i] / nearest2, MOST_IMPORTANT);
    }
}

void light_lanes_importance(const struct light_lanes *lanes, ps_vec3 position, ps_vec3 normal,
                            float importance[LIGHT_LANES])
{
    importance_of(lanes, position, normal, importance);
}

/* --- cost --- */

/* The integral of cos(w - theta_o) over the directions that the cone can send light into. */
static float measure_directions(const struct light_cluster *cluster)
{
    float cos_o = cluster->cos_theta_o, theta_o = safe_acos(cos_o);
    float theta_w = fminf(theta_o + safe_acos(cluster->cos_theta_e), PS_PI);
    float sin_o = sqrtf(ps_max(1.0f - cos_o * cos_o, 0.0f));
    return 2.0f * PS_PI * (1.0f - cos_o) +
           PS_PI / 2.0f *
               (2.0f * theta_w * sin_o - cosf(theta_o - 2.0f * theta_w) - 2.0f * theta_o * sin_o +
                cos_o);
}

float light_cluster_cost(const struct light_cluster *cluster)
{
    ps_vec3 diagonal = ps_subtract(cluster->high, cluster->low);
    return cluster->intensity * measure_directions(cluster) * ps_dot(diagonal, diagonal);
}
