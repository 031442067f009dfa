/* pov.h: makes a .psd scene of a scene of POV-Ray, version 3.7 or older.
 *
 * The language is that of the reference of POV-Ray 3.7,
 * https://www.povray.org/documentation/3.7.0/. It is a program that is run while it is read; what
 * it may cost is limited. What psplat has no counterpart for is replaced by the nearest, or left
 * out, with a warning that names file and line, once for each kind. Meshes become files beside the
 * scene; pictures that the scene names are referred to where they are.
 *
 * No state outside of the arguments; may run in several threads at once.
 */
#ifndef POV_POV_H
#define POV_POV_H

#include "base/error.h"
#include "parser/yaml/diagnostic.h"
#include "writer/warnings.h"
#include "writer/written_scene.h"
#include <stdint.h>

/* Where Debian's povray-includes has the files of #include. */
#define POV_SYSTEM_INCLUDE "/usr/share/povray-3.7/include"

/* What a scene may cost where the options don't say. */
#define POV_MOST_STEPS ((size_t)100000000) /* tokens that are read, in loops each time */
#define POV_MOST_MEMORY                                                                            \
    ((size_t)1024 * 1024 * 1024) /* bytes of values and of what they are made of */
#define POV_LARGEST_FILE ((size_t)64 * 1024 * 1024) /* of each included file */
#define POV_MOST_FILES 256                          /* different ones */

struct pov_options {
    /* The only one to read from (base/input_file.h), but for `system`; or NULL. */
    const char *folder;
    const char *const *libraries; /* folders where #include looks too */
    size_t library_count;
    const char *system;       /* the last of them, which is always allowed; or NULL */
    const char *base;         /* names of files beside the scene begin with it */
    const char *scene_folder; /* of the scene that is read: "" or ending in a slash */
    const char *from_output;  /* the same, seen from the folder of the .psd; UTF-8, as `base` */
    uint64_t device, serial;  /* of the scene's file (base/file.h); 0: not known */
    size_t most_steps, most_memory; /* 0: as many as usual */
};

/* Converts a text; `name` stands in messages. Errors and warnings go to the sink. Not PS_OK: there
 * is an error in the sink, and `scene` is empty. */
ps_result pov_convert(const char *name, const char *text, size_t length,
                      const struct pov_options *options, struct diagnostics *sink,
                      struct written_scene *scene);

/* Converts the file at `path` and writes `output`, which ends in ".psd", and the files beside it
 * (writer/import_file.h). What is wrong with the scene goes to the sink (PS_ERROR_INVALID), what is
 * wrong with writing to `error`, whose text is empty otherwise. `options` may lack what the paths
 * say. */
ps_result pov_import(const char *path, const char *output, const struct pov_options *options,
                     struct diagnostics *sink, struct error *error);

#endif
