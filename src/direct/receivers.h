/* receivers.h: next-event estimation: points that sample the lights.
 *
 * Where the scene has few lights, each point samples all of them. Where it has more than twice
 * lighting.choices, each draws that many by the light BVH (scene/light_bvh.h), which costs the
 * same whatever their number, and has noise. Of lights below lighting.light_threshold some are
 * drawn in either case. Sun and sky are always sampled. Of a mesh of many triangles a point
 * samples one that the BVH chooses.
 */
#ifndef DIRECT_RECEIVERS_H
#define DIRECT_RECEIVERS_H

#include "direct/direct.h"

#define RECEIVERS_MOST 256

/* Points of a surface hit, or of the G-buffer, of which only position and normal are known. */
struct receivers {
    const struct lighting *lighting;
    size_t n; /* at most RECEIVERS_MOST */
    const ps_vec3 *positions, *normals;
    const ps_ray *rays; /* NULL: irradiance is asked for */
    const ps_hit *hits;
    const uint8_t *groups; /* bits of ps_light_group: the lights that each asks for; NULL: all */
    float (*numbers)[4];   /* choose points on lights; NULL: no light has a size */
    const double *choices; /* choose lights; NULL: none is chosen */
    /* Sums of what lights give that cast hard shadows (scene_light_casts_hard_shadows); NULL:
     * nobody asks. */
    ps_rgb *hard;
    uint64_t *occlusion; /* what rays to the lights met, see gbuffer_occlusion; NULL: nobody asks */
};

/* Whether `choices` are needed: to choose lights, or parts of them. */
bool receivers_need_choices(const struct lighting *lighting);

/* Adds what the lights give: irradiance, or the radiance that the surfaces hit reflect. */
void receivers_add_lights(const struct receivers *receivers, ps_rgb *sums);

/* The chance of a ray that leaves a surface at `origin` in `direction` and meets a light at
 * `distance`, where the front's normal is `normal`, to have been drawn by a receiver there, 1/sr;
 * see light_pdf. A receiver that has a normal draws by it too, and weighs as if it did not: weights
 * need the same density on both ways of finding a light, not the true one. */
float receivers_light_pdf(const struct lighting *lighting, size_t light, ps_vec3 origin,
                          ps_vec3 direction, float distance, ps_vec3 normal);

#endif
