/* import_file.h: from the file of another renderer's scene to the files of a .psd scene. */
#ifndef WRITER_IMPORT_FILE_H
#define WRITER_IMPORT_FILE_H

#include "base/file.h"
#include "writer/written_scene.h"

struct import_paths {
    const char *base;         /* names of files beside the scene begin with it */
    const char *scene_folder; /* of the scene that is read: "" or ending in a slash */
    const char *from_output;  /* the same, seen from the folder of the .psd; UTF-8, as `base` */
};

/* Converts a text; `name` stands in messages. Not PS_OK: it reported why, and `scene` is empty. */
typedef ps_result (*import_convert)(void *user, const char *name, const struct file_text *text,
                                    const struct import_paths *paths, struct written_scene *scene);

/* Converts the file at `path` and writes `output`, which ends in ".psd", and the files beside it
 * (scene_files.h). What is wrong with reading or writing goes to `error`, whose text is empty
 * otherwise. */
ps_result import_file(const char *path, const char *output, import_convert convert, void *user,
                      struct error *error);

#endif
