/* override.h: `--set KEY.KEY=VALUE`: values that the command line puts into the tree. */
#ifndef PARSER_LANGUAGE_OVERRIDE_H
#define PARSER_LANGUAGE_OVERRIDE_H

#include "parser/language/assignment.h"

/* The tree with the values set; what it shared, and the tree itself, are left as they are. Where a
 * path leads nowhere, that is reported, and that value is not set. */
const struct node *override_tree(struct reader *reader, const struct assignments *sets,
                                 struct budget *budget, const struct node *root);

#endif
