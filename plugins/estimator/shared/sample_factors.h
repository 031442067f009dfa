/* sample_factors.h: how many samples each point of a tile takes, relative to the others.
 *
 * A denoiser averages a pixel with the n pixels of the same surface around it. What is left of a
 * variance v with s samples each is v / (n s); for a fixed number of samples in all it is least
 * with s in proportion to 1 / sqrt(n). So pixels of thin things (chair legs, window frames) and at
 * edges take more.
 */
#ifndef PSPLAT_ESTIMATOR_SAMPLE_FACTORS_H
#define PSPLAT_ESTIMATOR_SAMPLE_FACTORS_H

#include <psplat/plugin.h>

enum { SAMPLE_FACTOR_MOST = 4 };

/* Finds the factor of each point: 1 to SAMPLE_FACTOR_MOST times the samples of one whose surface
 * all around show. Other tiles do not count, so that a part of a picture is as in the whole. */
void sample_factors(const ps_points *points, float *factors);

#endif
