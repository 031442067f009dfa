/* landings.h: where light first lands, by light paths. */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_LANDINGS_H
#define PSPLAT_ESTIMATOR_RADIOSITY_LANDINGS_H

#include "element.h"

/* Divides triangles until few light paths land in each, and finds the power of the lights where all
 * paths land. PS_ERROR_MEMORY or PS_CANCELLED. */
ps_result landings_divide(struct elements *elements);

#endif
