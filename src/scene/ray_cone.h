/* ray_cone.h: how much of a picture a hit stands for.
 *
 * A ray that is one of few in its solid angle stands for a cone around it (Amanatides 1984;
 * Akenine-Moller et al. 2019, "Texture level of detail strategies for real-time ray tracing"), and
 * its hit for the part of the surface that the cone covers. Pictures are looked up as their mean
 * over that. Its width in texture coordinates is kept, in eighths of its binary logarithm, in the
 * bits of ps_hit.flags that are psplat's own, so that whatever looks at the hit's colours later has
 * it.
 */
#ifndef SCENE_RAY_CONE_H
#define SCENE_RAY_CONE_H

#include <math.h>
#include <psplat/types.h>

#define RAY_CONE_SHIFT 24   /* PS_HIT_OWN */
#define RAY_CONE_STEPS 8.0f /* in an octave */
#define RAY_CONE_LEAST (-22.0f)
#define RAY_CONE_LAST 255.0f /* 0: a point */

/* The bits for the binary logarithm of a width; -INFINITY: a point, as all below RAY_CONE_LEAST
 * are. */
static inline uint32_t ray_cone_flags(float log_width)
{
    float steps = roundf((log_width - RAY_CONE_LEAST) * RAY_CONE_STEPS);
    if (!(steps > 0.0f))
        return 0;
    return (uint32_t)fminf(steps, RAY_CONE_LAST) << RAY_CONE_SHIFT;
}

/* The binary logarithm. */
static inline float ray_cone_log_width(const ps_hit *hit)
{
    uint32_t steps = hit->flags >> RAY_CONE_SHIFT;
    return steps > 0 ? RAY_CONE_LEAST + (float)steps / RAY_CONE_STEPS : -INFINITY;
}

#endif
