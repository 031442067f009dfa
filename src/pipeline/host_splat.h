/* host_splat.h: the part of the host's services that splats what was placed, and finds light from nearby. */
#ifndef PIPELINE_HOST_SPLAT_H
#define PIPELINE_HOST_SPLAT_H

#include <psplat/host.h>

/* Fills in the functions begin_splats, splat and gather_short_range. */
void host_add_splatting(ps_host *host);

#endif
