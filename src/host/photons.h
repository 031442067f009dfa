/* photons.h: photons become splats, for those who look at single splats (debug views). */
#ifndef HOST_PHOTONS_H
#define HOST_PHOTONS_H

#include "render/state.h"

/* The splats of n photons, by the chosen visibility; those that may light nothing in view have radius 0 while the
 * render is splatting. Main thread. */
void photons_place(struct render *render, const ps_photon *photons, size_t n, struct splat *splats);

/* Adds the light of splats that were placed; cuts their depth ranges to their maps. */
ps_result photons_add_splats(struct render *render, struct splat *splats, size_t n,
                             struct error *error);

#endif
