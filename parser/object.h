/* object.h: the objects of the file and of groups. */
#ifndef PARSER_OBJECT_H
#define PARSER_OBJECT_H

#include "parser/keys.h"
#include "parser/reader.h"
#include "parser/schema.h"

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
    bool hidden;               /* as that is */
    struct group_entry *group; /* whose objects they are, or NULL: the file's (group.h) */
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

#endif
