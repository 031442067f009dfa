/* scene_input.h: what `render` and `check` share: a scene file and settings laid over it, with all
 * problems printed. */
#ifndef CLI_SCENE_INPUT_H
#define CLI_SCENE_INPUT_H

#include "cli/scene_options.h"
#include "render/settings.h"
#include "scene/scene.h"

struct scene_input {
    struct diagnostics *sink;
    struct loader *loader;
    struct scene_description description;
};

/* Reads the scene. If that fails, prints why to stderr and returns false; release it in any case.
 */
bool scene_input_read(struct scene_input *input, const char *path,
                      const struct scene_options *options);

/* Lays "KIND=NAME[:KEY=VALUE,...]" over the scene's settings. Prints what is wrong with it. */
bool scene_input_override(struct scene_input *input, const char *text);

/* Checks and loads the strategies; prints problems with their places in the file. */
bool scene_input_resolve(struct scene_input *input, uint32_t threads, size_t batch,
                         struct render_settings *settings);

/* Makes the scene, and prints the warnings of all steps. An error that has a place in a file is printed
 * too, and its text is empty then. */
ps_result scene_input_build(struct scene_input *input, struct scene *scene, struct error *error);

void scene_input_release(struct scene_input *input);

#endif
