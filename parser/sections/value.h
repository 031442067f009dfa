/* value.h: the values of keys, from nodes to parameter text (base/param.h) and into a state. */
#ifndef PARSER_SECTIONS_VALUE_H
#define PARSER_SECTIONS_VALUE_H

#include "parser/schema/schema.h"
#include "parser/sections/reader.h"

/* Which key of which section a value is for, in messages. */
struct subject {
    const char *key, *section;
};

/* A scalar's text; NULL, reported, where it is none. `expected` says what would have been right. */
const char *value_text(const struct reader *reader, struct subject subject, const struct node *node,
                       const char *expected);

/* Checks the value against the row and stores it in the state; false where it was reported. */
bool value_set(struct reader *reader, struct subject subject, const struct schema_row *row,
               const struct node *node, void *state);

/* Reads one number; false where it was reported. */
bool value_number(const struct reader *reader, struct subject subject, const struct node *node,
                  double *number);

/* Reads a list of three integers, 0 to largest. */
bool value_indices(struct reader *reader, struct subject subject, const struct node *node,
                   uint32_t largest, uint32_t indices[3]);

#endif
