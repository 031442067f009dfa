/* radius.h: the radius of a footprint (steps 1 to 3 and 6 of placement.h). */
#ifndef PLACEMENT_RADIUS_H
#define PLACEMENT_RADIUS_H

#include "placement/placement.h"

/* Of so many paths in a pass (from 0), in a scene of that radius whose light lands `light_spread`
 * wide (render/photons.h; 0: not known). */
float radius_automatic(float scene_radius, float light_spread, uint64_t paths, uint32_t pass);

/* Within which gather rays find light, where the settings leave the radius open. */
float radius_automatic_gather_distance(float scene_radius, float light_spread, uint64_t paths);

/* The same by the settings; 0 where bundles do not start at their photons and follow the
 * distance. */
float radius_gather_distance(const struct placement_scene *scene,
                             const struct footprint_params *settings, uint64_t paths);

/* Of the disc that the light of a photon may fill that meets `hit`. */
float radius_largest(const struct placement_scene *scene, const struct footprint_params *settings,
                     const ps_photon *photon, const ps_hit *hit);

/* Below which the radius at that distance does not fall. */
float radius_smallest(const struct placement_scene *scene, const ps_photon *photon, float distance,
                      float largest);

/* Where the light travels so far; `largest`: radius_largest. */
float radius_at(const struct placement_scene *scene, const struct footprint_params *settings,
                const ps_photon *photon, float largest, float distance);

/* From which distance on a splat gives all of the photon's light; 0: at every one. */
float radius_blend_distance(const struct placement_scene *scene, const ps_photon *photon);

/* A length from the settings as a float that the ray tracer can bear: past the scene is nothing. */
static inline float radius_bounded(const struct placement_scene *scene, double length)
{
    double most = 4.0 * (double)scene->radius;
    return (float)(length < most ? length : most);
}

#endif
