/* skylight.h: irradiance of surfels straight from skies, which changes slowly from place to place.
 *
 * In a room next-event estimation seldom finds the sky: one shadow ray in some tens gets out. So a
 * gather ray that asked for it where it lands would bring more noise than light. Surfels ask many
 * times each, and a gather ray takes the mean of those around its end. Not so for a sky with a sun
 * in its picture, whose shadows a mean would blur: PS_LIGHTS_SOFT.
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_SKYLIGHT_H
#define PSPLAT_ESTIMATOR_GATHER_SKYLIGHT_H

#include "surfels.h"

/* Whether the scene has a sky. */
bool skylight_is_there(const ps_host *host);

/* Sets surfels->sky, the mean of so many shadow rays from each surfel, if there are any.
 * PS_ERROR_MEMORY or PS_CANCELLED: release the surfels all the same. */
ps_result skylight_find(const ps_pass *pass, uint64_t rays, struct surfels *surfels);

#endif
