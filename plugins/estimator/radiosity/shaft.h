/* shaft.h: whether nothing can stand between two triangles.
 *
 * Haines and Wallace 1991, Shaft culling for efficient ray-cast radiosity: all lines between two
 * boxes lie in their convex hull, whose sides are parallel to an axis each. A triangle that lies
 * outside of one of them, or behind the plane of one of the two, is in no line's way. Where the
 * scene has no other, every point of the one sees every point of the other, which no number of
 * shadow rays can tell.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_SHAFT_H
#define PSPLAT_ESTIMATOR_RADIOSITY_SHAFT_H

#include "element.h"

/* Of two elements that are triangles. Any thread. */
bool shaft_is_empty(const struct elements *elements, uint32_t p, uint32_t q);

#endif
