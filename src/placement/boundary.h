/* boundary.h: walls beside a photon, behind which part of its full bundle would start (step 5 of
 * placement.h).
 *
 * A kernel estimate loses what its kernel spreads past the border of its domain: at a straight
 * border half of it (Jones 1993, "Simple boundary correction for kernel density estimation"). A
 * full bundle's domain is the lit surface that its disc starts on, and where a wall stands on that
 * surface, the rays that start behind it light nothing: photon splatting darkens along creases, by
 * a band as wide as the splats, and no finer map brings that light back.
 *
 * Sixteen short rays run from the photon along its tangent plane, past twice the rim of the disc: a
 * pixel's ray may start at the rim, and half of the disc around that start lies past it. Photons in
 * one place share them. Across each bundle, their nearest hits give up to two straight walls; a
 * pixel whose ray starts at distance d (in radii) in front of a wall then divides the kernel by the
 * part of a disc around that start that lies on this side (of two walls: kernel_left), which is the
 * share of the photons around it that could exist at all. That is exact for even light on a plane,
 * and not only in the mean: dividing by the part of the photon's own disc would keep the energy,
 * and put it into the wrong place. A pixel whose ray starts behind a wall gets nothing of the
 * splat: photons there are others, or none. The wall itself does not always see to that, since it
 * may be a chair's back, which ends.
 *
 * Rays near the ground that are stopped all around, where higher ones go on, tell a hollow surface
 * (the inside of a sphere), which has no walls; its bundles start higher, so as not to be stopped
 * by itself.
 */
#ifndef PLACEMENT_BOUNDARY_H
#define PLACEMENT_BOUNDARY_H

#include "placement/splat.h"
#include <psplat/host.h>

/* Finds the walls of n placed full bundles, and where they start; those of radius 0 are left out.
 * Any thread. */
void boundary_find(const ps_host *host, float surface_offset, const ps_photon *photons, size_t n,
                   struct splat *splats);

#endif
