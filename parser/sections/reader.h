/* reader.h: what the steps from tree to scene description share. */
#ifndef PARSER_SECTIONS_READER_H
#define PARSER_SECTIONS_READER_H

#include "parser/yaml/diagnostic.h"
#include "parser/yaml/node.h"
#include "scene/description.h"

struct mesh_ahead;

/* Steps report errors and go on, so that one run finds many; they leave the description releasable.
 * Running out of memory is noted, and reported once at the end. */
struct reader {
    const char *file; /* the main one; owned by the description */
    struct diagnostics *sink;
    struct scene_description *description;
    struct arena *arena;               /* of the tree */
    struct names materials, groups;    /* indices, see reference.c */
    struct names textures;             /* indices, by what makes them the same */
    struct group_entry *group_entries; /* of each group, see group.c */
    size_t object_count;               /* in the file and all groups */
    struct mesh_ahead *ahead;          /* as psd_options has it */
    bool allow_plugin_paths;           /* likewise */
    bool out_of_memory;
};

/* Where the node was written; of a node that was made, the main file. */
struct origin reader_origin(const struct reader *reader, const struct node *at);

/* Reports an error at the node; nothing where the node is NODE_BROKEN. */
void reader_error(const struct reader *reader, const struct node *at, const char *format, ...)
    PRINTF_LIKE(3, 4);

void reader_error_list(const struct reader *reader, const struct node *at, const char *format,
                       va_list arguments) PRINTF_LIKE(3, 0);

/* Adds a file to those that the description knows, and returns its name for nodes and origins; NULL
 * when out of memory, noted. */
const char *reader_add_file(struct reader *reader, const char *name);

/* Zeroed memory for the description, or NULL, noted. For a count of 0 it is NULL too. */
void *reader_allocate(struct reader *reader, size_t count, size_t size);

/* The path of a file that the node names: an absolute one as it is, another from the folder of the
 * file in which the node was written (from the working folder where that is standard input or the
 * command line). Owned by who puts it into the description; NULL when out of memory, noted. */
char *reader_path(struct reader *reader, const struct node *node, const char *text);

/* A copy of the text for the description, or NULL, noted. */
char *reader_copy(struct reader *reader, const char *text);

/* Room for `more` items behind the `count` that the array has, zeroed. Returns the array, which may
 * have moved, or NULL, noted, where it stays as it is. An array that grows so must only grow so. */
void *reader_extend(struct reader *reader, void *array, size_t count, size_t more, size_t size);

#endif
