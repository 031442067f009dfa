/* light_shares.h: which part of the light paths each light should have, by what camera paths found
 * of its light.
 *
 * A path of a light of power Phi that is of use to the picture brings about Phi. Where the light
 * gives S to the picture, S / Phi of its paths are of use, and of all shares those in proportion to
 * sqrt(S Phi) have the least variance. A part of the paths goes by power alone, so that no light
 * that was missed is lost.
 *
 * What few camera paths find of one light is noise. So what is found of a run of lights is shared
 * among its halves as if a few more finds had been made there by power, and so on down to single
 * lights.
 */
#ifndef IMPORTANCE_LIGHT_SHARES_H
#define IMPORTANCE_LIGHT_SHARES_H

#include <stddef.h>
#include <stdint.h>

/* Light that camera paths found of a light: its sum, and how often some was found. */
struct found_light {
    double sum;
    double times;
};

/* The shares, which need not sum to 1; they are 0 only where the power is. `order`: of the lights,
 * neighbours side by side; `powers`, `found`, `shares`: of each light. */
void light_shares(const uint32_t *order, const float *powers, const struct found_light *found,
                  size_t count, float *shares);

#endif
