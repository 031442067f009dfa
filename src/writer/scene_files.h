/* scene_files.h: writes a converted scene and the files beside it. */
#ifndef WRITER_SCENE_FILES_H
#define WRITER_SCENE_FILES_H

#include "base/error.h"
#include "writer/written_scene.h"

/* All or none, to `output` and into `folder`, its own: "" or ending in a slash. `input`, the scene
 * that was read, and the files that it names are not overwritten: PS_ERROR_INVALID. */
ps_result scene_files_write(const struct written_scene *scene, const char *input,
                            const char *output, const char *folder, struct error *error);

#endif
