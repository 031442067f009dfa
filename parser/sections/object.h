/* object.h: the objects of the file, of groups and of mesh files. */
#ifndef PARSER_SECTIONS_OBJECT_H
#define PARSER_SECTIONS_OBJECT_H

#include "parser/schema/keys.h"
#include "parser/schema/schema.h"
#include "parser/sections/reader.h"

/* An attack by groups of groups makes many objects of a small text. */
#define MOST_OBJECTS ((size_t)1000000)

struct object_list {
    struct object_description *items;
    size_t count;
};

/* Where objects go that are read. */
struct object_context {
    struct object_list *list;
    struct affine placement;   /* of what surrounds them */
    bool hidden, front_only;   /* as that is */
    struct group_entry *group; /* whose objects they are, or NULL: the file's (group.c) */
    int level;                 /* how many groups wait for this one */
};

/* Reads a list of objects; `name` is the key that it stands under. */
void objects_read(struct reader *reader, const char *name, const struct node *list,
                  const struct object_context *context);

/* Appends the object, which the list owns from then on, placed as the context says. False where
 * there is no room, which is noted or reported. */
bool object_append(struct reader *reader, const struct node *at,
                   const struct object_context *context, const struct object_description *object);

/* The context with what an object's keys say about its placement; false where it was reported. */
bool object_place(struct reader *reader, const struct item *item, const struct object_keys *keys,
                  const struct object_context *context, struct object_context *placed);

/* --- groups: objects by name, and their instances ---------------------------------------------
 *
 * A description's groups hold no instances: those that the file has in a group are resolved into
 * copies, and groups that contain themselves are errors.
 */

/* Adds the groups to the description, and their names to the reader. */
void groups_read(struct reader *reader, const struct node *root);

/* Reads an instance: an object of the file, or copies of objects in a group. */
void group_instance(struct reader *reader, const struct item *item, const struct object_keys *keys,
                    const struct object_context *context);

/* --- mesh files as objects
 * --------------------------------------------------------------------- */

/* Reads the file that the keys name, and adds what is used of it to the description. */
void object_mesh_read(struct reader *reader, const struct item *item,
                      const struct object_keys *keys, const struct object_context *context);

/* --- what a mesh file brought ------------------------------------------------------------------
 *
 * Everything that is moved is the description's from then on; what the fragment keeps is to be
 * released with it. Materials and textures that nothing uses stay behind, so that no picture is
 * loaded for a material that the scene replaces.
 */

/* For each material of the fragment one of the description that replaces it, or NO_INDEX. */
struct fragment {
    struct scene_description *content;
    const size_t *replacements; /* content->material_count of them */
    size_t otherwise;           /* for objects of other materials; NO_INDEX: the fragment's */
    bool keep_materials;        /* those that nothing replaces */
};

/* Appends all to the description, objects to the context's list. Returns how many objects had no
 * material and got the plain one (import.h). Running out of memory is noted. */
size_t fragment_append(struct reader *reader, const struct node *at,
                       const struct fragment *fragment, const struct object_context *context);

#endif
