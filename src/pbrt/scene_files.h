/* scene_files.h: writes a converted scene and the files beside it. */
#ifndef PBRT_SCENE_FILES_H
#define PBRT_SCENE_FILES_H

#include "pbrt/pbrt.h"

/* All or none, to `output` and into `folder`, its own: "" or ending in a slash. `input`, the pbrt scene, and the files
 * that it names are not overwritten: PS_ERROR_INVALID. */
ps_result scene_files_write(const struct pbrt_scene *scene, const char *input, const char *output,
                            const char *folder, struct error *error);

#endif
