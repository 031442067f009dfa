/* splats.h: how a pass begins to splat. */
#ifndef HOST_SPLATS_H
#define HOST_SPLATS_H

#include "render/state.h"

/* Photons placed, and their splats added, at a time: the length of render.placed. */
#define SPLATS_PLACED 4096

/* See ps_host.begin_splats. */
ps_result splats_begin(struct render *render, uint32_t n, struct error *error);

/* See ps_host.begin_points and ps_host.end_points; n > 0. */
ps_result splats_begin_points(struct render *render, const ps_vec3 *positions,
                              const ps_vec3 *normals, size_t n, struct error *error);
void splats_end_points(struct render *render, ps_rgb *irradiance);

/* The irradiance of the points by the splats so far, which goes on. */
void splats_read_points(const struct render *render, ps_rgb *irradiance);

/* Forgets the splatter onto pixels, if there is one, and points that an estimator left. */
void splats_drop_pixels(struct render *render);
void splats_drop_points(struct render *render);

#endif
