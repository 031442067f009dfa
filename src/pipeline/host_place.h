/* host_place.h: the part of the host's services that carries photons to the surfaces that they light, and puts
 * boxes around their bundles there.
 */
#ifndef PIPELINE_HOST_PLACE_H
#define PIPELINE_HOST_PLACE_H

#include "pipeline/render_state.h"
#include "splat/footprint.h"

/* Fills in the functions place_footprints and place_splats. */
void host_add_placing(ps_host *host);

/* Before the first splats of a pass. */
void host_begin_placing(struct render *render);

/* What boxes need to know of the scene and the pass. */
struct footprint_scene host_footprint_scene(const struct render *render);

#endif
