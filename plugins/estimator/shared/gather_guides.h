/* gather_guides.h: the guides of a gather: which of its points share one, how it faces, and what
 * the rays of the first round are drawn by. */
#ifndef PSPLAT_ESTIMATOR_GATHER_GUIDES_H
#define PSPLAT_ESTIMATOR_GATHER_GUIDES_H

#include "gather_rays.h"

/* Begins a guide for each way that the points face, which know of no light; part of
 * gather_begin(). */
void gather_choose_guides(struct gather *gather);

/* Has photons guide the first round, if gather->setting->photons are given; and guides of bent
 * surfaces then face as those points do which get most of the light. */
void gather_guide_first(struct gather *gather);

#endif
