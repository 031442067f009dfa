/* host_splat.h: the part of the host's services that carries sources to surfaces and splats them. */
#ifndef PIPELINE_HOST_SPLAT_H
#define PIPELINE_HOST_SPLAT_H

#include <psplat/host.h>

/* Fills in the functions place_boxes, begin_splats, place_splats, splat,
 * gather_near_light. */
void host_add_splatting(ps_host *host);

#endif
