/* assignment.h: what the command line assigns: `--param NAME=VALUE` and `--set KEY.KEY=VALUE`.
 *
 * Messages about them look as those about files: the option is the file, and the lines are what was
 * given with it, one after the other.
 *
 *     --set:1:13: error: width in image: expected integer 1..65536, got 'wide'
 *         1 | image.width=wide
 *           |             ^~~~
 */
#ifndef PARSER_LANGUAGE_ASSIGNMENT_H
#define PARSER_LANGUAGE_ASSIGNMENT_H

#include "parser/sections/reader.h"
#include "parser/yaml/document.h"

struct assignment {
    const char *key;
    const char *value;
    const char *file; /* the option */
    struct mark key_mark, value_mark;
};

struct assignments {
    struct assignment *items;
    size_t count;
};

/* Splits the texts at their first '='. Reports those that have none, and what is no UTF-8. False
 * where that, or running out of memory (noted), leaves nothing to go on with. Of the reader's arena
 * and description. */
bool assignments_read(struct reader *reader, const char *option, const char *const *texts,
                      size_t count, struct assignments *assignments);

/* The value as YAML; NULL where that was reported, or memory ran out (noted). */
const struct node *assignment_value(struct reader *reader, const struct assignment *assignment,
                                    struct budget *budget);

/* A node that stands for a part of the key; its text is of the arena. NULL when out of memory,
 * noted. `start` and `length` are in bytes. */
const struct node *assignment_key(struct reader *reader, const struct assignment *assignment,
                                  size_t start, size_t length);

#endif
