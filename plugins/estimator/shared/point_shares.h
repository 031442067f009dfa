/* point_shares.h: how many samples the points of a tile take, for those of the whole tile.
 *
 * A denoiser averages a pixel with those of the same surface around. What is thin, chair legs and window frames, and what
 * lies at edges has few of them, and keeps the more noise: of n pixels alike with s samples each, what is left of a variance
 * v is v / (n s), and so many samples in all leave the least where s is as 1 / sqrt(n).
 */
#ifndef PSPLAT_ESTIMATOR_POINT_SHARES_H
#define PSPLAT_ESTIMATOR_POINT_SHARES_H

#include <psplat/plugin.h>

enum { POINT_SHARES_MOST = 4 };

/* Finds the share of each point: 1 to POINT_SHARES_MOST times the samples of one that all around are like. Other tiles are
 * not looked at, so that a part of a picture is as in the whole. */
void point_shares(const ps_points *points, float *shares);

#endif
