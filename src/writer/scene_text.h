/* scene_text.h: the .psd text that is made, section by section (psd(5)).
 *
 * Sections are streams in memory, put together at the end, since scenes of other renderers state
 * them in any order. The first failure, of memory, shows in scene_text_finish. Owned by a
 * converter; one thread.
 */
#ifndef WRITER_SCENE_TEXT_H
#define WRITER_SCENE_TEXT_H

#include "writer/name_index.h"
#include "writer/transform.h"
#include "writer/written_scene.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct text_buffer {
    FILE *stream; /* NULL: not open */
    char *bytes;
    size_t length;
};

/* Room for `wanted` items of that size in a list. False: out of memory. */
bool scene_text_grow(void **items, size_t *capacity, size_t wanted, size_t size);

/* False: out of memory. */
bool text_buffer_open(struct text_buffer *buffer);
/* The text, to be freed; NULL: out of memory. The buffer is closed either way. */
char *text_buffer_close(struct text_buffer *buffer);

struct scene_material {
    char *name, *text;
};

/* Of a material or a group. */
struct scene_name {
    char *name;
    size_t next; /* the number behind the next one that is wanted to be called that */
};

struct scene_text {
    struct text_buffer camera, image, materials, lights, groups, group, objects;
    struct scene_material *interned;
    size_t material_count, material_capacity;
    struct name_index by_text; /* of the materials */
    struct scene_name *names;  /* unique in the scene */
    size_t name_count, name_capacity;
    struct name_index by_name;
    struct side_file *files;
    size_t file_count, file_capacity;
    char **named; /* paths of files that the scene that was read names */
    size_t named_count, named_capacity;
    size_t inline_numbers; /* of meshes (mesh.h) */
    bool failed;
};

bool scene_text_open(struct scene_text *scene);
void scene_text_release(struct scene_text *scene);

/* Puts the sections together. False: out of memory. */
bool scene_text_finish(struct scene_text *scene, const char *comment, struct written_scene *result);

/* How many values YAML finds in a text of this form: one for each opening, comma and colon, and two
 * for a line. */
size_t scene_text_values(const char *text);

/* A name that was not given before, near to the wanted one; owned by the scene. NULL: out of
 * memory. */
const char *scene_text_name(struct scene_text *scene, const char *wanted);

/* The name of the material of that text, which is added where it is new. NULL: out of memory. */
const char *scene_text_material(struct scene_text *scene, const char *wanted, const char *text);

/* A new file beside the scene, named BASE-WHAT-NUMBER.SUFFIX; its contents are for the caller to
 * put in. NULL: out of memory. */
struct side_file *scene_text_file(struct scene_text *scene, const char *base, const char *what,
                                  const char *suffix);

/* Notes that the scene that was read names the file of that path. False: out of memory. */
bool scene_text_note(struct scene_text *scene, const char *path);

/* Values, as YAML, in the precision of floats, as psplat has them. */
void put_number(FILE *out, double value);
void put_vector(FILE *out, struct vector value);
void put_color(FILE *out, const double rgb[3]); /* a number where all are the same */
void put_text(FILE *out, const char *text);     /* quoted */
void put_path(FILE *out, const char *path);     /* the same of a file's */
/* ", matrix: [...]"; nothing for the identity. */
void put_placement(FILE *out, const struct transform *placement);

#endif
