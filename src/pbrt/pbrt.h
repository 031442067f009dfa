/* pbrt.h: makes a .psd scene of a scene of pbrt, versions 3 and 4.
 *
 * The file formats are those of https://pbrt.org/fileformat-v4 and https://pbrt.org/fileformat-v3.
 * What psplat has no counterpart for is replaced by the nearest, or left out, with a warning that
 * names file and line, once for each kind. Large meshes and converted pictures become files beside
 * the scene; mesh and texture files that the pbrt scene names are referred to where they are.
 *
 * No state outside of the arguments; may run in several threads at once.
 */
#ifndef PBRT_PBRT_H
#define PBRT_PBRT_H

#include "base/error.h"
#include "parser/yaml/diagnostic.h"
#include "writer/warnings.h"
#include "writer/written_scene.h"

struct pbrt_options {
    int version;              /* 3 or 4; 0: as the words of the scene tell */
    const char *folder;       /* the only one to read from (base/input_file.h), or NULL */
    const char *base;         /* names of files beside the scene begin with it */
    const char *scene_folder; /* of the pbrt scene: "" or ending in a slash */
    const char *from_output;  /* the same, seen from the folder of the .psd; UTF-8, as `base` */
    uint64_t device, serial;  /* of the pbrt scene's file (base/file.h); 0: not known */
    size_t most_triangles;    /* that subdivision may make; 0: as many as usual */
};

/* Converts a text; `name` stands in messages. Errors and warnings go to the sink. Not PS_OK: there
 * is an error in the sink, and `scene` is empty. */
ps_result pbrt_convert(const char *name, const char *text, size_t length,
                       const struct pbrt_options *options, struct diagnostics *sink,
                       struct written_scene *scene);

/* Converts the file at `path` and writes `output`, which ends in ".psd", and the files beside it
 * (scene_files.h). What is wrong with the scene goes to the sink (PS_ERROR_INVALID), what is wrong
 * with writing to `error`, whose text is empty otherwise. `options` may lack all but version and
 * folder. */
ps_result pbrt_import(const char *path, const char *output, const struct pbrt_options *options,
                      struct diagnostics *sink, struct error *error);

#endif
