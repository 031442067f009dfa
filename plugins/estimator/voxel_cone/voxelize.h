/* voxelize.h: the finest level of the volume: surfaces found by lines, lit by lights and photons.
 *
 * Lines along an axis tell how much of a voxel is covered, seen along it, and where they meet a
 * surface first in each voxel, the radiance that this reflects of the lights is asked for: so
 * direct light is as free of noise as its shadow rays, and is known from both sides of a wall. The
 * paper takes it from a shadow map that each light renders.
 *
 * Light that has met more surfaces comes by photons. One of power P that leaves a surface with
 * normal n into a voxel of side s is radiance on the three sides that n faces,
 *
 *     light_k += P / pi * max(0, n_k) / s^2,
 *
 * which is its radiant intensity along axis k over the area of a voxel's side. Photons that gloss
 * and mirrors send out do the same around the direction that they leave to: a lobe as wide as six
 * sides can hold. Photons are few, and cones look closely at what is near: so photons are collected
 * on a level so coarse that its voxels get some each, and the voxels below share the radiance.
 */
#ifndef PSPLAT_VOXEL_CONE_VOXELIZE_H
#define PSPLAT_VOXEL_CONE_VOXELIZE_H

#include "../shared/surface_lines.h"
#include "volume.h"

/* Finds the surfaces, and what they reflect of the lights. Release the volume whatever it returns.
 * Main thread. */
ps_result voxelize(const struct surface_lines *lines, const ps_pass *pass, struct volume *volume);

/* Light of photons, on one level. */
struct photon_light {
    const ps_host *host;
    const struct volume *volume;
    uint32_t level;
    ps_rgb (*light)[6]; /* of each voxel; owned */
    uint64_t lost;      /* photons that no voxel is near */
};

/* Begins to collect the photons of `paths` light paths, after the levels are built. Release it
 * whatever it returns. */
ps_result photon_light_create(const struct volume *volume, uint64_t paths,
                              struct photon_light *light);
void photon_light_add(struct photon_light *light, const ps_photon *photon);
void photon_light_release(struct photon_light *light);

#endif
