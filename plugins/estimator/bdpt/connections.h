/* connections.h: connections of pixels' paths to light paths.
 *
 * A surface x that a pixel's path met gets from every vertex y of the pixel's light path
 *
 *     throughput * f(x) cos(x) * f(y) cos(y) / d^2 * power(y) * V(x, y)
 *
 * weighed against all other ways to make the same path (subpath.h). A shadow ray for each pair that face each other, in
 * batches, tells V.
 */
#ifndef PSPLAT_ESTIMATOR_CONNECTIONS_H
#define PSPLAT_ESTIMATOR_CONNECTIONS_H

#include "light_paths.h"

/* Adds what the ends of the walk get to the sums, which go by lanes. `at_points`: they are pixels' points, whose
 * scattering does not count as a bounce. */
void connect_to_lights(const struct bdpt *bdpt, const struct walk *walk, int at_points,
                       const struct light_vertices *vertices, ps_rgb *sums);

#endif
