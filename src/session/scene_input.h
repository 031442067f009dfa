/* scene_input.h: the way from a scene file, and what is laid over it, to a scene and settings. All
 * problems on the way are reported to one sink: errors where a step fails, and warnings.
 */
#ifndef SESSION_SCENE_INPUT_H
#define SESSION_SCENE_INPUT_H

#include "job/transport.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "session/scene_options.h"

struct scene_input {
    struct diagnostics *sink;
    struct scene_description description;
};

/* PS_ERROR_MEMORY. Release it in any case. */
ps_result scene_input_create(struct scene_input *input, struct error *error);
void scene_input_release(struct scene_input *input);

/* Reads the scene, from a file or a text (see psd_read_text_with). A mesh file is a scene by itself
 * (model/model.h). */
ps_result scene_input_read(struct scene_input *input, const char *path,
                           const struct scene_options *options);
ps_result scene_input_read_text(struct scene_input *input, const char *name, const char *text,
                                size_t length, const struct scene_options *options);

/* Reads the scene by the first of some processes, and gives it to all of them. */
ps_result scene_input_share(struct scene_input *input, const char *path,
                            const struct scene_options *options, const struct transport *transport);

/* What a process that does not come so far calls instead: the others wait for it. */
void scene_input_share_none(const struct transport *transport);

/* Lays "KIND=NAME[:KEY=VALUE,...]" over the scene's settings. */
ps_result scene_input_override(struct scene_input *input, const char *text);

/* Checks and loads the strategies, and starts the threads. */
ps_result scene_input_resolve(const struct render_description *description, uint32_t threads,
                              size_t batch, struct diagnostics *sink,
                              struct render_settings *settings);

/* Makes the scene. */
ps_result scene_input_build(struct scene_input *input, struct scene *scene);

#endif
