/* lighting.h: the direct light of the elements, and the reflectances by which they pass it on.
 *
 * Each undivided triangle takes the mean over 16 stratified points of what shadow rays find there.
 * Small pools of light on large triangles would fall between the points: so light paths are traced
 * to the first surfaces beforehand, and triangles divided until none has more than a share of them;
 * and then where the quarters of one differ by more than a share of all light, which is at the
 * edges of shadows.
 *
 * The mean of 16 points is a few per cent off in each element. Where all light paths landed, the
 * light of all elements is known, as it is what the lights send out: the means are brought to it.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_LIGHTING_H
#define PSPLAT_ESTIMATOR_RADIOSITY_LIGHTING_H

#include "element.h"

/* Divides the triangles where light falls, and lights all. PS_ERROR_MEMORY or PS_CANCELLED. */
ps_result lighting_begin(struct elements *elements, double epsilon);

/* Lights the elements [first, end), which have no children. */
void lighting_add(struct elements *elements, size_t first, size_t end);

/* Gives each element with children their mean. */
void lighting_pull(struct elements *elements);

/* The same when all elements are there, and brings them to the light that the lights send out. */
void lighting_finish(struct elements *elements);

#endif
