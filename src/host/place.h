/* place.h: the placement of batches of photons (src/placement), with what the render knows. */
#ifndef HOST_PLACE_H
#define HOST_PLACE_H

#include "placement/placement.h"
#include "render/state.h"

/* Before the first splats of a pass. */
void place_begin(struct render *render);

/* What footprints need to know of the scene and the pass. */
struct placement_scene place_scene(const struct render *render);

/* The splats of n photons, by the chosen visibility; those that may light nothing in view have radius 0 while the
 * render is splatting. Main thread. */
void place_splats(struct render *render, const ps_photon *photons, size_t n, struct splat *splats);

#endif
