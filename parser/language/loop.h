/* loop.h: `for` and `if` in lists. */
#ifndef PARSER_LANGUAGE_LOOP_H
#define PARSER_LANGUAGE_LOOP_H

#include "parser/language/expand.h"

/* Whether an item of a list is a loop or a condition: a map with one of their keys. */
bool loop_is(const struct node *node);

/* Appends the items that it makes to the list. */
void loop_expand(struct expansion *expansion, const struct node *node, int depth,
                 struct node *list);

#endif
