/* fresnel.h: how much of the light a smooth surface reflects, by angle.
 *
 * Schlick 1994 for metals and coats, whose colour at normal incidence users state; Fresnel's
 * equations for unpolarized light at the surface of glass and water, where total reflection
 * matters.
 */
#ifndef SCENE_FRESNEL_H
#define SCENE_FRESNEL_H

#include <psplat/math.h>

/* (1 - cosine)^5 */
static inline float fresnel_rise(float cosine)
{
    float base = 1.0f - fminf(fmaxf(cosine, 0.0f), 1.0f);
    float square = base * base;
    return square * square * base;
}

/* Reflectance at the cosine to the normal, of a surface that reflects f0 at normal incidence. */
static inline ps_rgb fresnel_schlick(ps_rgb f0, float cosine)
{
    float rise = fresnel_rise(cosine);
    return (ps_rgb){f0.r + (1.0f - f0.r) * rise, f0.g + (1.0f - f0.g) * rise,
                    f0.b + (1.0f - f0.b) * rise};
}

/* Reflectance between two dielectrics, 0..1. `eta`: index of the far side over that of the near
 * one. Sets the cosine of the refracted direction, 0 where all is reflected. */
static inline float fresnel_dielectric(float cosine, float eta, float *refracted_cosine)
{
    float sine2 = (1.0f - cosine * cosine) / (eta * eta);
    if (sine2 >= 1.0f) {
        *refracted_cosine = 0.0f;
        return 1.0f;
    }
    float far_cosine = sqrtf(1.0f - sine2);
    float parallel = (eta * cosine - far_cosine) / (eta * cosine + far_cosine);
    float perpendicular = (cosine - eta * far_cosine) / (cosine + eta * far_cosine);
    *refracted_cosine = far_cosine;
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

#endif
