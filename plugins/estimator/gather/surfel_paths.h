/* surfel_paths.h: surfels' light by splats, corrected by paths of their own.
 *
 * Splats know where the light is, but are blotched, and a few percent off where kernels are wide. Paths are right on average. To their
 * ends they are long, so few of them set the splats right; then most are of one segment, and ask the table of what the first ones
 * made for what comes after it, as irradiance caches of several bounces do (Ward et al. 1988).
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_SURFEL_PATHS_H
#define PSPLAT_ESTIMATOR_GATHER_SURFEL_PATHS_H

#include "surfels.h"

/* Corrects the irradiance of surfels, of which there are some, by so many paths of one segment from each, after a quarter as many to their ends, from which
 * Russian roulette may take paths after `roulette` bounces. All go to their ends where they are few, and where bounces are counted: the
 * table would tell of one too many. Surfels then have the light that only diffuse surfaces and rough gloss (PS_ROUGH_GLOSS) have scattered. PS_ERROR_MEMORY
 * or PS_CANCELLED: what they have means nothing. */
ps_result surfel_paths_correct(const ps_pass *pass, uint32_t roulette, uint64_t paths,
                               struct surfels *surfels);

#endif
