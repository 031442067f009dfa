/* short_range_gather.h: finds the light from closer than splats are wide, by short rays from the
 * pixels.
 *
 * A kernel blurs what is smaller than itself: light that comes from nearer than a radius, along
 * creases and under what stands close to a wall. There splats would have to be as small as the
 * gaps, and would be so noisy that they dominate the error. So what lights throw onto surfaces
 * nearby is found by short rays, cosine-distributed (after Kollig and Keller 2006, "Illumination
 * in the presence of weak singularities", who make up for the clamped light of near virtual
 * lights), and splats leave it out, all of it at no distance, and less and less of it further away
 * (placement/gather_share.h). The shares add up to 1, so nothing counts twice. Light that other
 * surfaces threw there is smooth, and caustics are found by light paths alone: both are splatted
 * all the way.
 *
 * Rays are shared out among tiles by their noise (short_range_pilot.h).
 */
#ifndef SHORT_RANGE_SHORT_RANGE_GATHER_H
#define SHORT_RANGE_SHORT_RANGE_GATHER_H

#include "short_range/short_range_light.h"
#include <psplat/host.h>

/* Fills near->found, which gathered_light_begin zeroed. `rays`: of a pixel in the middle of a
 * surface and those that it is averaged with, on average. PS_CANCELLED when the user stops it. */
ps_result short_range_gather(const ps_host *host, const ps_pass *pass, struct gathered_light *near,
                             double rays);

#endif
