/* stages.h: the parts of the driver: what a render needs before its first pass, and its end. */
#ifndef PIPELINE_STAGES_H
#define PIPELINE_STAGES_H

#include "image/image.h"
#include "render/state.h"

/* Makes all that passes share, and starts the strategies; needs scene, settings, callbacks, statistics and hosts.
 * Whether it succeeds or not, destroy it. */
ps_result render_create(struct render *render, struct error *error);
void render_destroy(struct render *render);

/* Starts all strategies; destroying the render stops them. */
ps_result render_start_strategies(struct render *render, struct error *error);

/* Makes what is no number, or negative, 0; returns how many values there were. */
uint64_t mend_plane(float *plane, size_t n);

/* Of a picture, less the planes that it takes over from the film. */
size_t picture_bytes(size_t width, size_t height);

/* Film to image: normalization, ambient fallback, denoiser, combination. Uses up the film. Where memory runs
 * out there is no image; where a strategy fails or is stopped, the result says so, and there is an image
 * without what it does. */
ps_result resolve_image(struct render *render, struct image *image, struct error *error);

#endif
