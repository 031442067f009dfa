/* host_place.h: the part of the host's services that carries sources to the surfaces that they light, and puts
 * boxes around their beams there.
 */
#ifndef PIPELINE_HOST_PLACE_H
#define PIPELINE_HOST_PLACE_H

#include "pipeline/render_state.h"
#include "splat/box.h"

/* Fills in the functions place_boxes and place_splats. */
void host_add_placing(ps_host *host);

/* Before the first splats of a pass. */
void host_begin_placing(struct render *render);

/* What boxes need to know of the scene and the pass. */
struct box_scene host_box_scene(const struct render *render);

#endif
