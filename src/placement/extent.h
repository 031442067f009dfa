/* extent.h: how large the footprint of a full bundle must be (step 4 of placement.h).
 *
 * Each pixel takes its own part of a bundle's disc, which is as wide as its distance from the photon allows
 * (bandwidth.h). The footprint must hold all these parts. Where the axis meets something near, a part of the bundle
 * may go by and light what lies far behind with the whole disc; where the axis meets nothing, what stands
 * beside it may be lit all the same. Rays over the largest disc find both. Without them, what is seen past
 * chairs and blocks loses the light of all photons whose own ray these stop: in the Cornell box the front
 * of the ceiling was 6 % too dark with splats of 100 mm.
 */
#ifndef PLACEMENT_EXTENT_H
#define PLACEMENT_EXTENT_H

#include "placement/placement.h"

/* Lessens the radii of n full bundles, which are the largest (or 0: left out), to what the pixels of
 * anything that the bundle meets may ask for. A bundle that meets nothing gets a hit on its axis, as far
 * away as the nearest thing beside it (but no nearer than its radius), with a normal of 0, as its
 * slope is anything. One whose disc meets nothing either stays as large: what is thinner than the space between
 * the rays may stand there, as mullions before the sky do, which lost a sixth of their light. Any thread. */
void extent_find(const struct placement *placement, const ps_photon *photons, size_t n,
                 ps_hit *hits, float *radii);

#endif
