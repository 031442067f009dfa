/* reference.h: what the file names to refer to it from elsewhere: materials and groups. */
#ifndef PARSER_REFERENCE_H
#define PARSER_REFERENCE_H

#include "parser/reader.h"

/* Makes index `index` known by the name; a name that is known gets the new index. */
void reference_put(struct reader *reader, struct names *names, const char *name, size_t index);

/* False where the name is not known. */
bool reference_get(const struct names *names, const char *name, size_t *index);

/* Finds what a scalar names; false, and an error that suggests a name, where there is no such
 * thing. */
bool reference_material(const struct reader *reader, const struct node *node, size_t *index);
bool reference_group(const struct reader *reader, const struct node *node, size_t *index);

#endif
