/* photon_guide.h: guides for the first rays of a gather, by where its photons came from.
 *
 * Rays that find light teach guides (guide.h), but where little light comes from a small part of
 * the hemisphere, as in a dark room with a patch of sun, a first ray that finds any is a matter of
 * luck. Photons know such places (Jensen 1995, "Importance driven path tracing using the photon
 * map"): as virtual lights, of which some points of a group draw a few by what they would give
 * without shadows (resampled importance sampling, Talbot et al. 2005), and ask for shadows then.
 * What they give is coarse, and is not the light: it is where rays go. Photons on rough gloss shine
 * all around, too, or rays would be led away from what they light.
 */
#ifndef PSPLAT_ESTIMATOR_PHOTON_GUIDE_H
#define PSPLAT_ESTIMATOR_PHOTON_GUIDE_H

#include "guide.h"

#include "virtual_lights.h"

/* Virtual lights that are of use. */
enum { PHOTON_GUIDE_LIGHTS = 4096 };

/* Virtual lights, coordinate by coordinate. */
struct photon_guide {
    const ps_host *host;
    size_t count;
    float *x, *y, *z, *normal_x, *normal_y, *normal_z, *power; /* owned: one block, from x on */
    float nearest;                                             /* shorter distances count as this */
};

/* Of lights that were drawn of a pass's photons; PS_ERROR_MEMORY. Release it whatever it
 * returns. */
ps_result photon_guide_create(const struct virtual_lights *lights, struct photon_guide *guide);
void photon_guide_release(struct photon_guide *guide);
bool photon_guide_is_there(const struct photon_guide *guide); /* made and not released */

enum { PHOTON_GUIDE_DRAWS = 64 };

/* Light that gets to points of a group. */
struct photon_guide_draws {
    size_t count;
    size_t points[PHOTON_GUIDE_DRAWS];
    int halves[PHOTON_GUIDE_DRAWS]; /* of the points */
    ps_ray rays[PHOTON_GUIDE_DRAWS];
    float light[PHOTON_GUIDE_DRAWS]; /* irradiance, but for a factor that is the same for all */
};

/* `index`: of the group, among all that draw random numbers. Any thread. */
void photon_guide_draw(const struct photon_guide *photons, const ps_pass *pass,
                       const ps_points *points, uint64_t index, struct photon_guide_draws *drawn);

#endif
