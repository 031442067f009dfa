/* render_scene.h: renders scene texts inside of a test. */
#ifndef TESTS_SUPPORT_RENDER_SCENE_H
#define TESTS_SUPPORT_RENDER_SCENE_H

#include "pipeline/render.h"

struct rendering {
    struct image image;
    struct statistics statistics;
};

/* Renders `text` with choices such as "injection=photon:count=1000" laid over it; ends with NULL.
 * Indirect light is that of one bounce, by splats, not denoised and without smooth edges, where
 * neither the text nor a choice ("bounces=3", "bounces=all", "estimator=...") says otherwise. A
 * failure fails the test. Release it with rendering_release. */
struct rendering render_text(const char *text, uint32_t threads, const char *const choices[]);
/* The same with splats in batches of `batch`. */
struct rendering render_text_in_batches(const char *text, uint32_t threads, size_t batch,
                                        const char *const choices[]);
void rendering_release(struct rendering *rendering);

/* All that a render needs, for one render; as render_text has it. */
struct prepared {
    struct scene_description description;
    struct scene scene;
    struct loader *loader;
    struct render_settings settings;
};

void prepare_text(const char *text, uint32_t threads, size_t batch, const char *const choices[],
                  struct prepared *prepared);
void prepared_release(struct prepared *prepared);

/* Calls `inspect` with a render of the text whose G-buffer is filled (render_inspect), on two
 * threads. */
struct render;
void inspect_text(const char *text, const char *const choices[],
                  ps_result (*inspect)(void *user, struct render *render, struct error *error),
                  void *user);

/* A number, or "all", as the scene language's `bounces`. */
ps_number_or_choice bounces_of(const char *text);

/* A scene of the text, with no rendering; the caller releases it with scene_release. */
struct scene scene_of_text(const char *text);

/* Mean of a channel over the rectangle of pixels [x, x + width) x [y, y + height). */
double mean_of(const struct image *image, const char *channel, size_t x, size_t y, size_t width,
               size_t height);
double mean_of_all(const struct image *image, const char *channel);

/* Deviation of the rectangle's pixels from the mean of the four beside them, which are in the
 * picture, over their mean. */
double grain_of(const struct image *image, const char *channel, size_t x, size_t y, size_t width,
                size_t height);

/* Fails the test unless both have the same channels, bit for bit. */
void expect_same_image(const struct image *a, const struct image *b);

/* The text of scenes/NAME.psd at this size; from PSPLAT_SOURCE. The caller frees it. */
char *scene_file_text(const char *name, int width, int height);

/* The Cornell box of scenes/cornell.psd at this size, with splats of radius 30 and maps of 4x4;
 * from PSPLAT_SOURCE. The caller frees the text. */
char *cornell_text(int width, int height);

#endif
