/* splats.h: how a pass begins to splat. */
#ifndef HOST_SPLATS_H
#define HOST_SPLATS_H

#include "render/state.h"

/* Photons placed, and their splats added, at a time: the length of render.placed. */
#define SPLATS_PLACED 4096

/* See ps_host.begin_splats. */
ps_result splats_begin(struct render *render, uint32_t n, struct error *error);

#endif
