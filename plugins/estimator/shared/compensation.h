/* compensation.h: the light that clamped virtual point lights leave out.
 *
 * Kollig and Keller 2006, "Illumination in the presence of weak singularities". A light at distance
 * d below the clamp c gives d^2 / c^2 of its light. The rest is an integral over the surfaces y
 * within c of the point x, along rays w:
 *
 *     E(x) - E_clamped(x) = integral of L(y(x, w)) max(0, 1 - d^2 / c^2) cos(theta) dw
 *
 * L is the radiance that y reflects diffusely. Rays are drawn by cos(theta) / pi; few meet anything
 * as close, so they cost little. Kollig and Keller find L by all virtual lights again, clamped, and
 * so on recursively; here the rest of the path is traced, which has the same mean, and costs a few
 * rays instead of one for each light.
 */
#ifndef PSPLAT_ESTIMATOR_COMPENSATION_H
#define PSPLAT_ESTIMATOR_COMPENSATION_H

#include "paths.h"

/* Row of a parameter `compensation`, an int64_t. */
#define COMPENSATION_RAYS(state)                                                                   \
    PS_ROW(state, compensation, PS_PARAM_INT, "4", 0, 1 << 16, PS_PARAM_QUALITY, NULL, "rays",     \
           "rays for each pixel and pass that find what clamp leaves out; 0: it is lost")

#define COMPENSATION_ROULETTE 3 /* the bounce from which on Russian roulette may end a path */

struct compensation {
    struct paths_setting paths;
    uint64_t rays; /* for each point; 0: nothing is added */
    float clamp;   /* 0: as well */
};

/* Adds the irradiance (W/m^2) that lights leave out at points of a tile. Any thread. */
void compensation_add(const struct compensation *compensation, uint64_t tile,
                      const ps_points *points, ps_rgb *irradiance);

#endif
