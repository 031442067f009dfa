/* place.h: carries photons to the surfaces that they light, and puts the footprints of splats there. */
#ifndef HOST_PLACE_H
#define HOST_PLACE_H

#include "render/state.h"
#include "splat/footprint.h"

/* Before the first splats of a pass. */
void place_begin(struct render *render);

/* What footprints need to know of the scene and the pass. */
struct footprint_scene place_scene(const struct render *render);

/* The splats of n photons, by the chosen visibility; those that may light nothing in view have radius 0 while the
 * render is splatting. Main thread. */
void place_splats(struct render *render, const ps_photon *photons, size_t n, struct splat *splats);

#endif
