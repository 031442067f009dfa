/* photons.h: photons become splats, for those who look at single splats (debug views). */
#ifndef HOST_PHOTONS_H
#define HOST_PHOTONS_H

#include "render/state.h"

/* The splats of n photons, by the chosen visibility; those that may light nothing in view have
 * radius 0 while the render is splatting. Main thread. */
void photons_place(struct render *render, const ps_photon *photons, size_t n, struct splat *splats);

#endif
