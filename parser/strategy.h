/* strategy.h: the plugins that `render` names, with their parameters as text. */
#ifndef PARSER_STRATEGY_H
#define PARSER_STRATEGY_H

#include "parser/value.h"

/* Reads `NAME` or `{NAME: {PARAMETER: VALUE, ...}}` into a zeroed choice; false where something was
 * reported. The plugin's own table checks the parameters later. */
bool strategy_read(struct reader *reader, struct subject subject, const struct node *node,
                   struct strategy_choice *choice);

#endif
