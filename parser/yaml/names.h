/* names.h: finds things by name. */
#ifndef PARSER_YAML_NAMES_H
#define PARSER_YAML_NAMES_H

#include "base/arena.h"
#include <stdbool.h>

/* Zeroed: empty. Its memory is the arena's. */
struct names {
    struct names_branch *root;
};

/* What was put under the name, or NULL. */
void *names_get(const struct names *names, const char *name);

/* Puts `value` under the name, in place of what was there. The text of `name` must live as long as
 * the table. False when out of memory. */
bool names_put(struct names *names, struct arena *arena, const char *name, void *value);

#endif
