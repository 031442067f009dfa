#include "splat/bounds.h"

#include <math.h>

/* Relative to the coordinates: some steps of rounding. */
#define ROUNDING 1e-6f

struct bound bound_empty(void)
{
    return (struct bound){
        {INFINITY, INFINITY, INFINITY},
        {-INFINITY, -INFINITY, -INFINITY},
        {INFINITY, INFINITY, INFINITY},
        {-INFINITY, -INFINITY, -INFINITY},
    };
}

static ps_vec3 minimum(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){ps_min(a.x, b.x), ps_min(a.y, b.y), ps_min(a.z, b.z)};
}

static ps_vec3 maximum(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){ps_max(a.x, b.x), ps_max(a.y, b.y), ps_max(a.z, b.z)};
}

void bound_add_point(struct bound *bound, ps_vec3 position, ps_vec3 normal)
{
    bound->low = minimum(bound->low, position);
    bound->high = maximum(bound->high, position);
    bound->normal_low = minimum(bound->normal_low, normal);
    bound->normal_high = maximum(bound->normal_high, normal);
}

void bound_add(struct bound *bound, const struct bound *other)
{
    bound->low = minimum(bound->low, other->low);
    bound->high = maximum(bound->high, other->high);
    bound->normal_low = minimum(bound->normal_low, other->normal_low);
    bound->normal_high = maximum(bound->normal_high, other->normal_high);
}

static void set_interval(float low, float high, float *center, float *extent)
{
    *center = 0.5f * (low + high);
    *extent = 0.5f * (high - low) + ROUNDING * (fabsf(low) + fabsf(high));
}

void bounds_set(struct bounds *bounds, uint32_t i, const struct bound *bound)
{
    if (!(bound->low.x <= bound->high.x)) {
        bounds->center_x[i] = bounds->center_y[i] = bounds->center_z[i] = BOUNDS_NOWHERE;
        bounds->extent_x[i] = bounds->extent_y[i] = bounds->extent_z[i] = 0.0f;
        bounds->normal_low_x[i] = bounds->normal_low_y[i] = bounds->normal_low_z[i] = 0.0f;
        bounds->normal_high_x[i] = bounds->normal_high_y[i] = bounds->normal_high_z[i] = 0.0f;
        return;
    }
    set_interval(bound->low.x, bound->high.x, &bounds->center_x[i], &bounds->extent_x[i]);
    set_interval(bound->low.y, bound->high.y, &bounds->center_y[i], &bounds->extent_y[i]);
    set_interval(bound->low.z, bound->high.z, &bounds->center_z[i], &bounds->extent_z[i]);
    bounds->normal_low_x[i] = bound->normal_low.x - ROUNDING;
    bounds->normal_low_y[i] = bound->normal_low.y - ROUNDING;
    bounds->normal_low_z[i] = bound->normal_low.z - ROUNDING;
    bounds->normal_high_x[i] = bound->normal_high.x + ROUNDING;
    bounds->normal_high_y[i] = bound->normal_high.y + ROUNDING;
    bounds->normal_high_z[i] = bound->normal_high.z + ROUNDING;
}
