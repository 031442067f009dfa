/* eye_paths.h: paths from the pixels of a tile, and their connections to lights and light paths.
 *
 * At each surface that a path meets, the light of the lights is added by next-event estimation, and
 * that of the pixel's light path by connections; emission that is met is added as well. All are
 * weighed against each other, against longer and shorter light paths, and against light tracing
 * (subpath.h). At the pixel's point there are connections to light paths alone: what lights give to
 * it is direct light.
 */
#ifndef PSPLAT_ESTIMATOR_EYE_PATHS_H
#define PSPLAT_ESTIMATOR_EYE_PATHS_H

#include "connections.h"

/* One path from each point: adds its irradiance to the sums. `samples`: the index of each lane's
 * random numbers; `sights`: of the tile. */
void eye_paths_trace(const struct bdpt *bdpt, const ps_points *points, const struct sight *sights,
                     const uint64_t *samples, const struct light_vertices *vertices,
                     struct tile_sums *sums);

#endif
