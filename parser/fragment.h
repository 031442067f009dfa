/* fragment.h: joins what a mesh file brought with the description.
 *
 * Everything that is moved is the description's from then on; what the fragment keeps is to be
 * released with it. Materials and textures that nothing uses stay behind, so that no picture is
 * loaded for a material that the scene replaces.
 */
#ifndef PARSER_FRAGMENT_H
#define PARSER_FRAGMENT_H

#include "parser/object.h"

/* For each material of the fragment one of the description that replaces it, or NO_INDEX. */
struct fragment {
    struct scene_description *content;
    const size_t *replacements; /* content->material_count of them */
    size_t otherwise;           /* for objects of other materials; NO_INDEX: the fragment's */
    bool keep_materials;        /* those that nothing replaces */
};

/* Appends all to the description, objects to the context's list. Returns whether each object got a
 * material; those without are left out. Running out of memory is noted. */
bool fragment_append(struct reader *reader, const struct node *at, const struct fragment *fragment,
                     const struct object_context *context);

#endif
