/* short_range_pilot.h: how gather rays are shared out among tiles, by their noise (Neyman 1934, "On
 * the two different aspects of the representative method").
 *
 * A part of the rays goes ahead as a pilot, which tells the noise: where the sun shines on what is
 * near it is hundreds of times that of a dark corner. The light that the pilot finds does not
 * count: where it happens to find more than there is, more rays follow, so that the mean of all of
 * them would be too small.
 *
 * Shares are of the whole picture, and so is the pilot, where a window of it is rendered: tiles are
 * known by their numbers in the picture here.
 */
#ifndef SHORT_RANGE_SHORT_RANGE_PILOT_H
#define SHORT_RANGE_SHORT_RANGE_PILOT_H

#include "short_range/short_range_rays.h"

/* The largest part of the rays that a tile may have, of 1 on average. */
#define GATHER_PILOT_LARGEST_SHARE 16.0

/* Fills near->noises and mean_noise; `window_rays` as in gather. PS_CANCELLED when the user stops
 * it. */
ps_result gather_pilot(struct gather_rays *rays, double window_rays);

/* Of the rays of a tile, 1 on average or a little less. */
double gather_pilot_share(const struct gathered_light *near, uint64_t tile);

#endif
