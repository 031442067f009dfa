/* stages.h: the parts of the driver: what a render needs before its first pass, and its end. */
#ifndef PIPELINE_STAGES_H
#define PIPELINE_STAGES_H

#include "image/image.h"
#include "pipeline/planes.h"
#include "render/state.h"

/* Makes all that passes share, and starts the strategies; needs scene, settings, callbacks,
 * statistics and hosts. Whether it succeeds or not, destroy it. */
ps_result render_create(struct render *render, struct error *error);
void render_destroy(struct render *render);

/* Turns a render to the part that its settings now name, without passes. */
ps_result render_turn_to_part(struct render *render, struct error *error);

/* Starts the strategies of this kind and those after it, bloom and tone map only for a display;
 * destroying the render stops them. */
ps_result render_start_strategies(struct render *render, ps_kind first, struct error *error);

/* Says which of the strategies that make a picture of the film may make another one of a part of
 * it. */
void crop_warn(const struct render *render);

/* Tells plugins of a pass. */
void pass_describe(struct render *render, uint32_t number);

/* Renders a pass, and adds it to the sum where there is one. Where the user stops the first of
 * them, the film holds its direct light (struct render). */
ps_result pass_run(struct render *render, uint32_t number, struct error *error);

/* Looks at pass 0, which is another's, for what it tells of all: edges, and numbers of objects. */
void pass_look_at_first(struct render *render);

/* Pass 0 without indirect light: in the tiles and, averaged, in the film. */
void pass_light_first(struct render *render);

/* Makes what is no number, or negative, 0; returns how many values there were. */
uint64_t mend_plane(float *plane, size_t n);

/* PS_ERROR_MEMORY where the planes of a picture of the scene, with all that is made of them, do not
 * fit beside what the process has, and what the scene's textures may yet take. */
ps_result memory_check(const struct render_settings *settings, const struct planes *planes,
                       const struct scene *scene, bool keeps_film, struct error *error);

/* Whether so many bytes more fit beside what the process has. */
bool memory_allows(const struct render_settings *settings, double bytes);

/* A last stage that fails, or is stopped, must not cost the picture: it is left out, with a
 * warning. Returns `result`. */
ps_result leave_out(struct render *render, ps_kind kind, ps_result result, const char *instead,
                    struct error *error);

/* Film to image: normalization, ambient fallback, denoiser, combination; and display, if it
 * `shows`. Uses up the film. Where memory runs out there is no image; where a strategy fails or is
 * stopped, the result says so, and there is an image without what it does. */
ps_result resolve_image(struct render *render, bool shows, struct image *image,
                        struct error *error);

/* Adds the layer `display`, of zeros, to a picture. */
ps_result display_add(struct image *image, struct error *error);

/* Fills it from three planes of light. Where bloom or tone map fails, the layer is made without
 * them. */
ps_result display_fill(struct render *render, const float *const light[3], struct image *image,
                       struct error *error);

/* Makes of light, in place, what a display shows. */
ps_result display_show(struct render *render, float *const planes[3], size_t width, size_t height,
                       struct error *error);

#endif
