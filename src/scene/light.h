/* light.h: light sources: what they send out, and what they give to a point.
 *
 * A spotlight's edge is POV-Ray's: full intensity inside `radius`, none outside `falloff`, a smooth
 * cubic of the cosine in between.
 */
#ifndef SCENE_LIGHT_H
#define SCENE_LIGHT_H

#include "scene/description.h"

struct light {
    ps_vec3 location;
    ps_vec3 axis;                  /* unit; where a spot points */
    ps_rgb intensity;              /* W/sr */
    float cos_radius, cos_falloff; /* -1 for a light that shines all around */
};

struct light light_from_description(const struct light_description *description);

/* Radiant flux of the whole light, W. */
ps_rgb light_power(const struct light *light);

/* Intensity (W/sr) in unit direction `direction` away from the light. */
ps_rgb light_intensity(const struct light *light, ps_vec3 direction);

/* A ray from the light, uniform over its cone, and the flux (W) it stands for: intensity / pdf. */
ps_rgb light_emit(const struct light *light, float u1, float u2, ps_ray *ray);

#endif
