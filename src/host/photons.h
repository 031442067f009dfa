/* photons.h: what the services for splats do, for those who look at single splats (debug views). */
#ifndef HOST_PHOTONS_H
#define HOST_PHOTONS_H

#include "render/state.h"

/* See ps_host.begin_splats. */
ps_result photons_begin_splats(struct render *render, uint32_t n, struct error *error);

/* Adds the light of splats that were placed; cuts their depth ranges to their maps. */
ps_result photons_add_splats(struct render *render, struct splat *splats, size_t n,
                             struct error *error);

#endif
