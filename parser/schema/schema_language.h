/* schema_language.h: the tables of what works on the tree, before sections are read: parameters,
 * loops, conditions.
 */
#ifndef PARSER_SCHEMA_SCHEMA_LANGUAGE_H
#define PARSER_SCHEMA_SCHEMA_LANGUAGE_H

#include "parser/schema/schema.h"

/* A row that is read before the tables are. */
#define SCHEMA_OTHER_ROW(name_, domain_, absent_, help_)                                           \
    {                                                                                              \
        .param = {.name = (name_), .type = PS_PARAM_STRING, .unit = "", .help = (help_)},          \
        .form = SCHEMA_OTHER, .absent = (absent_), .domain = (domain_)                             \
    }

enum schema_type { TYPE_AUTO, TYPE_NUMBER, TYPE_VECTOR, TYPE_STRING };

/* What the sections "parameter", "for" and "if" fill. */
struct schema_parameter {
    int32_t type; /* enum schema_type */
};

struct schema_loop {
    double from, to, step;
};

struct schema_condition {
    int32_t holds;
};

/* The row of a key of the whole file, or NULL. */
const struct schema_row *schema_language_top(const char *key);

#endif
