/* reader.h: what the steps from tree to scene description share. */
#ifndef PARSER_READER_H
#define PARSER_READER_H

#include "parser/diagnostic.h"
#include "parser/node.h"
#include "scene/description.h"

/* Steps report errors and go on, so that one run finds many; they leave the description releasable.
 * Running out of memory is noted, and reported once at the end. */
struct reader {
    const char *file; /* owned by the description */
    struct diagnostics *sink;
    struct scene_description *description;
    struct arena *arena;
    struct names materials; /* struct material_description by name */
    bool out_of_memory;
};

struct origin reader_origin(const struct reader *reader, const struct node *at);

/* Reports an error at the node; nothing where the node is NODE_BROKEN. */
void reader_error(const struct reader *reader, const struct node *at, const char *format, ...)
    PRINTF_LIKE(3, 4);

/* Zeroed memory for the description, or NULL, noted. For a count of 0 it is NULL too. */
void *reader_allocate(struct reader *reader, size_t count, size_t size);

/* A copy of the text for the description, or NULL, noted. */
char *reader_copy(struct reader *reader, const char *text);

#endif
