/* surfel_paths.h: corrects the irradiance that splats gave the surfels, by paths from each surfel.
 *
 * Splats have low-frequency noise, and a bias of a few percent where kernels are wide. Paths are
 * unbiased, but noisy and long. So the correction (surfels_correct()) is done twice: with few paths
 * to their ends; then with many paths of one segment, which take the light beyond it from the table
 * that the first step made (irradiance caching with several bounces, Ward et al. 1988).
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_SURFEL_PATHS_H
#define PSPLAT_ESTIMATOR_GATHER_SURFEL_PATHS_H

#include "surfels.h"

/* `paths`: of one segment, from each surfel; before them a quarter as many (two at least) to their
 * ends, on which Russian roulette may act after `roulette` bounces. With fewer than four, or a
 * limited number of bounces (the table would count one too many), all paths go to their ends.
 * Surfels then hold light that only diffuse surfaces and rough gloss (PS_ROUGH_GLOSS) have
 * scattered. There is a surfel at least. PS_ERROR_MEMORY, PS_CANCELLED: the irradiance is
 * undefined. */
ps_result surfel_paths_correct(const ps_pass *pass, uint32_t roulette, uint64_t paths,
                               struct surfels *surfels);

#endif
