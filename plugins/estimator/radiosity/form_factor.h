/* form_factor.h: the part of the irradiance at a point that a triangle of radiosity 1 gives it: the
 * point's form factor.
 *
 * Lambert 1760: F = 1/(2 pi) sum over the edges of theta_k n . g_k, where theta_k is the angle that
 * edge k is seen under and g_k the unit normal of the plane through the edge and the point. It is
 * exact, also where the triangle touches the point's own surface, where the formula of small
 * surfaces, cos cos' A / (pi r^2), has no bound. What lies below the point's horizon is cut off
 * first. Any unit of length.
 */
#ifndef PSPLAT_ESTIMATOR_FORM_FACTOR_H
#define PSPLAT_ESTIMATOR_FORM_FACTOR_H

#include <psplat/math.h>

/* Of the front of a triangle, counter-clockwise, seen from x, whose unit normal is n. 0..1; 0 from
 * behind it. */
float form_factor_triangle(ps_vec3 x, ps_vec3 n, const ps_vec3 corners[3]);

/* Of a small surface: `facing` is its unit normal, and d = y - x the way to it. May be above 1
 * where it is near. */
static inline float form_factor_small(ps_vec3 n, ps_vec3 d, ps_vec3 facing, float area)
{
    float square = ps_dot(d, d), cosines = -ps_max(ps_dot(n, d), 0.0f) * ps_dot(facing, d);
    return cosines > 0.0f ? cosines * area / (PS_PI * square * square) : 0.0f;
}

#endif
