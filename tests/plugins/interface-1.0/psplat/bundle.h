/* bundle.h: points and rays of a bundle, for visibilities; see ps_bundle. */
#ifndef PSPLAT_BUNDLE_H
#define PSPLAT_BUNDLE_H

#include <psplat/math.h>

/* Where a point lies in a bundle: (u, v, t). */
static inline ps_vec3 ps_bundle_place(const ps_bundle *bundle, ps_vec3 point)
{
    ps_vec3 d = ps_subtract(point, bundle->centre);
    return (ps_vec3){ps_dot(d, bundle->axis_u), ps_dot(d, bundle->axis_v),
                     ps_dot(d, bundle->axis_w)};
}

static inline ps_vec3 ps_bundle_point(const ps_bundle *bundle, float u, float v, float t)
{
    ps_vec3 point = ps_add_scaled(bundle->centre, u, bundle->axis_u);
    point = ps_add_scaled(point, v, bundle->axis_v);
    return ps_add_scaled(point, t, bundle->axis_w);
}

/* The depth at which the ray at (u, v) starts. */
static inline float ps_bundle_start(const ps_bundle *bundle, float u, float v)
{
    return bundle->start_depth + u * bundle->start_slope_u + v * bundle->start_slope_v;
}

/* Where texel i of `side` texels across a bundle of that radius has its centre. */
static inline float ps_texel_centre(float radius, uint32_t side, uint32_t i)
{
    return (2.0f * ((float)i + 0.5f) / (float)side - 1.0f) * radius;
}

#endif
