/* render.h: the driver: scene and settings to a picture.
 *
 *     pass by pass: G-buffer -> direct light -> estimator -> film
 *     at the end:   normalization -> denoiser -> combine, and for display: bloom -> tone map
 *
 * A pass is a function of (scene, settings, seed, pass number); the film is the sum of passes, in
 * whatever order and groups.
 */
#ifndef PIPELINE_RENDER_H
#define PIPELINE_RENDER_H

#include "base/statistics.h"
#include "film/film_sum.h"
#include "image/image.h"
#include "render/callbacks.h"
#include "render/settings.h"
#include "scene/scene.h"

/* PS_ERROR_MEMORY where a picture of any scene takes more memory than the settings allow, or this
 * machine lends; render_run says so where that of its scene does. `keeps_film`: a film's file is
 * made of it. Allocates nothing. */
ps_result render_check_memory(const struct render_settings *settings, size_t width, size_t height,
                              bool keeps_film, struct error *error);

/* PS_ERROR_INVALID where the part of a picture of this size that the settings ask for does not lie
 * in it, or their estimator can't render a part. Before render_check_memory. */
ps_result render_check_crop(const struct render_settings *settings, size_t width, size_t height,
                            struct error *error);

/* The same for a picture that is put together of such parts: PS_ERROR_INVALID as well where
 * normalization, bloom or tone map go by all of it. */
ps_result render_check_parts(const struct render_settings *settings, size_t width, size_t height,
                             struct error *error);

/* The layers of a picture, beside R, G and B. */
#define RENDER_LAYERS "albedo, direct, display, error, indirect, N, P, weight, Z"

/* Whether the first `length` characters of `name` are that of a layer. */
bool render_makes_layer(const char *name, size_t length);

/* Renders into `image` (the layers of psplat(1)); the caller releases it. Starts the strategies of
 * `settings`, which may be used for one render only. `film`, where it is not NULL, holds passes
 * that were rendered before with the same scene and settings, or none; the others of the settings
 * are added to it. It has all planes then, for whatever denoiser; the caller releases it. When
 * cancelled, the passes that were complete make the picture and the result is PS_CANCELLED; without
 * any, the picture holds the direct light. Where a pass fails, those before it make the picture;
 * where the normalization or the denoiser fails, it is made without that: the result is their
 * failure. There is no picture where `image` is 0 x 0. */
ps_result render_run(const struct scene *scene, struct render_settings *settings,
                     const struct render_callbacks *callbacks, struct statistics *statistics,
                     struct film_sum *film, struct image *image, struct error *error);

/* Renders a picture of fewer pixels, each of which stands for a square of `step`, of which those of
 * the last column and row may reach out of it; of the settings' crop where there is one. One pass
 * is made; for the rest, see render_run. */
ps_result render_coarse(const struct scene *scene, struct render_settings *settings, double step,
                        const struct render_callbacks *callbacks, struct statistics *statistics,
                        struct image *image, struct error *error);

/* Parts of a picture, which may overlap. */
struct render_parts {
    const struct rectangle *places;
    uint32_t count; /* at least one */
    /* Is given the picture of each, in their order; it may take the channels out of it. A failure
     * ends the render. */
    ps_result (*take)(void *user, uint32_t part, struct image *image, struct error *error);
    void *user;
};

/* Renders the parts one after the other, each with all passes, as render_run does where the
 * settings' crop is that part; what the scene and its light need is made once. Memory is that of
 * one part. The settings' crop is the last one's when it returns. When cancelled, or where a part
 * fails, what there is of that part has been handed over, and the others are not made. */
ps_result render_run_parts(const struct scene *scene, struct render_settings *settings,
                           const struct render_callbacks *callbacks, struct statistics *statistics,
                           const struct render_parts *parts, struct error *error);

struct render;

/* The sum of the passes so far; NULL where a render of one pass keeps none. Of the pixels of no
 * pass, nothing is there. */
const struct film_sum *render_film(const struct render *render);

/* The first pass of the settings that the film lacks; false where it has them all. */
bool render_missing_pass(const struct render *render, uint32_t *number);

/* The picture of the passes that a render of several has so far, of which there is at least one;
 * likewise. From render_callbacks.next_pass alone. `display`: with the layer of that name, where
 * the settings ask for it. */
ps_result render_picture(struct render *render, bool display, struct image *image,
                         struct error *error);

/* The picture of a film, by normalization and denoiser of `settings`, whose strategies it starts.
 * Of the scene they know camera, center and radius alone (facts_view). Results are those of
 * render_run. */
ps_result render_resolve(struct film_sum *film, const struct scene *seen,
                         struct render_settings *settings, const struct render_callbacks *callbacks,
                         struct statistics *statistics, struct image *image, struct error *error);

/* Makes of three planes of light, in place, what a display shows: by bloom and tone map of
 * `settings`, which it starts, and which know no scene. Where it fails, the planes are of no
 * use. */
ps_result render_display(float *const planes[3], size_t width, size_t height,
                         struct render_settings *settings, const struct render_callbacks *callbacks,
                         struct error *error);

/* Looks at a render whose first pass has all but its indirect light: the G-buffer and direct light,
 * in the tiles and, averaged, in the film. May use the services as an estimator does. */
typedef ps_result (*render_inspector)(void *user, struct render *render, struct error *error);

/* Starts a render of one pass, lets the inspector look, and ends it; there is no picture. Starts
 * the strategies of `settings`, which may be used once. */
ps_result render_inspect(const struct scene *scene, struct render_settings *settings,
                         const struct render_callbacks *callbacks, struct statistics *statistics,
                         render_inspector inspect, void *user, struct error *error);

/* Starts the strategies and stops them again: whether they take their parameters, and the scene. */
ps_result render_try(const struct scene *scene, struct render_settings *settings,
                     const struct render_callbacks *callbacks, struct error *error);

/* Lets the estimator add the indirect light of the pass under way to the tiles. */
ps_result render_estimate(struct render *render, struct error *error);

#endif
