/* model.h: a lone mesh file as a scene.
 *
 * Whoever has a model and no scene wants to see it: whole, from a good side, and lit. The scene for
 * that is written as text, for the parser to read and for people to go on with, so that nothing
 * about it is hidden. What the file has itself, a camera or lights, goes before what it lacks.
 */
#ifndef MODEL_MODEL_H
#define MODEL_MODEL_H

#include "base/error.h"
#include "import/ahead.h"
#include "model/room.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What the scene depends on. */
struct model {
    struct box box; /* around it, with y upwards */
    int32_t up;     /* its own axis that becomes y: 0 x, 1 y, 2 z */
    bool has_materials, has_camera, has_lights;
    struct room room;
};

/* Whether the file is one, by the end of its name. */
bool model_is_file(const char *path);

/* How names of such files end, without the dot; NULL for an index beyond the last. */
const char *model_extension(size_t index);

/* The file, and how it may be read: as of struct mesh_request. */
struct model_file {
    const char *path, *folder, *cache;
    double memory_limit;
};

/* PS_ERROR_INVALID where nothing is to be seen in it, _IO or _MEMORY, with a message that names it.
 * `content`: what was read, for the scene that names the file; to be released, and empty after a
 * failure. */
ps_result model_read(const struct model_file *file, struct model *model, struct mesh_ahead *content,
                     struct error *error);

/* The scene, to be freed, in which the model is `file`: a path from where the scene's text is, in
 * UTF-8, that does not begin as a formula does. NULL when out of memory. */
char *model_scene_text(const struct model *model, const char *file);

/* A first scene without a model, with comments that tell what to change: lines, then NULL. */
extern const char *const model_first_scene[];

#endif
