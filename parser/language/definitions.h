/* definitions.h: the names that a scene gives: `define` and `parameters`. */
#ifndef PARSER_LANGUAGE_DEFINITIONS_H
#define PARSER_LANGUAGE_DEFINITIONS_H

#include "parser/language/assignment.h"
#include "parser/language/expand.h"
#include "parser/language/parameter.h"

/* Gives the scope of the expansion what the root of the tree defines: parameters, from the command
 * line or by default, then definitions, each with those before it in its formulas. */
void definitions_read(struct expansion *expansion, const struct node *root,
                      const struct assignments *given);

/* Calls back for each parameter; their values are the defaults. */
void definitions_list(struct expansion *expansion, const struct node *root,
                      void (*each)(void *user, const struct psd_parameter *parameter), void *user);

#endif
