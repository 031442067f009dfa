/* surfel_correction.h: the light of surfels by splats and by paths, together.
 *
 * Splats are smooth, but blotched, and a few percent too dark or too bright where kernels are wide.
 * Paths are right on average, with noise. So the splats of each group of surfels that lie close
 * together are multiplied by the ratio of the sums of both; then each surfel takes a mean of both,
 * weighted by their variances.
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_SURFEL_CORRECTION_H
#define PSPLAT_ESTIMATOR_GATHER_SURFEL_CORRECTION_H

#include "surfels.h"

/* Surfels of a group, but for the last one. The ratio of many has less noise, but spreads among
 * them what only paths have found, such as what rough gloss sends to a part of a wall. */
enum { SURFELS_OF_RATIO = 16 };

/* Corrects the surfels' irradiance, which is that of splats. `traced` is the irradiance by paths;
 * `half` is that by the first half of each surfel's paths, which tells the noise. PS_ERROR_MEMORY:
 * nothing happened. */
ps_result surfels_correct(struct surfels *surfels, const ps_rgb *traced, const ps_rgb *half);

#endif
