/* connections.h: connections of pixels' paths to light paths.
 *
 * A surface x that a pixel's path met gets from every vertex y of the pixel's light path
 *
 *     throughput * f(x) cos(x) * f(y) cos(y) / d^2 * power(y) * V(x, y)
 *
 * weighed against all other ways to make the same path (subpath.h). A shadow ray for each pair that
 * face each other, in batches, tells V. Where little would be brought, Russian roulette decides
 * whether one is traced (Veach 1997, section 10.3.4); what is little goes by what the tile's
 * samples before have brought, so the mean stays.
 */
#ifndef PSPLAT_ESTIMATOR_CONNECTIONS_H
#define PSPLAT_ESTIMATOR_CONNECTIONS_H

#include "light_paths.h"

/* The irradiance of a tile's pixels, W/m^2, times the number of samples. */
struct tile_sums {
    ps_rgb lanes[PS_TILE_PIXELS];
    uint32_t samples; /* that all lanes have */
};

/* The connections of one sample. */
struct connecting {
    const struct bdpt *bdpt;
    const struct light_vertices *vertices;
    const uint64_t *samples; /* the index of each lane's random numbers */
    struct tile_sums *sums;
    float small;        /* irradiance below which Russian roulette decides */
    uint32_t roulettes; /* so far: 0 to begin with */
};

/* What is small beside the mean of these samples. */
float connections_small(const struct tile_sums *sums);

/* Adds to the sums what the ends of the walk get. `at_points`: they are pixels' points, whose
 * scattering does not count as a bounce. */
void connect_to_lights(struct connecting *work, const struct walk *walk, int at_points);

#endif
