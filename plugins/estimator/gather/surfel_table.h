/* surfel_table.h: the mean light of the surfels around a point.
 *
 * A hash table holds the mean of the surfels in each cube of space, on surfaces of like normal and
 * the same material (after Binder et al. 2019, "Massively parallel path space filtering"). What is
 * darker or redder than its surroundings often gets another light as well, such as a window in its
 * recess: its reflectance times the mean light of all would be off in the mean. Cubes have a side
 * in proportion to the length of the ray, as wide as neighbouring rays are apart there, in powers
 * of two; where one has too few surfels, the next larger ones are looked up. What came by mirrors
 * or glass may be focused, and is looked up in smaller ones first. The lookup point is jittered
 * within a cube: steps between cubes become noise.
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_SURFEL_TABLE_H
#define PSPLAT_ESTIMATOR_GATHER_SURFEL_TABLE_H

#include "../shared/gather_rays.h"
#include "surfels.h"

/* Makes the table, when the surfels' light is set, in place of one that is there. PS_ERROR_MEMORY:
 * release the surfels all the same. */
ps_result surfel_table_build(struct surfels *surfels);

/* As a gather_lookup; `surfels` is a struct surfels. */
void surfel_table_lookup(const void *surfels, const struct gather_landing *landings, size_t n,
                         struct cached_irradiance *known, bool *is_known);

#endif
