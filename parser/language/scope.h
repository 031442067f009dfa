/* scope.h: the names that the formulas of a scene use: parameters, definitions, indices of
 * loops. */
#ifndef PARSER_LANGUAGE_SCOPE_H
#define PARSER_LANGUAGE_SCOPE_H

#include "parser/language/arithmetic.h"
#include "parser/sections/reader.h"

struct binding {
    const char *name;
    const struct node *at;    /* where it got its name */
    const struct node *value; /* without formulas; NULL: not reached yet */
    bool index;               /* of a loop */
    struct binding *hidden;   /* what the name meant outside of the loop */
    struct binding *next;
};

struct scope {
    struct reader *reader;
    struct names names;    /* struct binding */
    struct binding *first; /* all, for suggestions */
};

/* Adds a name without a value; NULL, reported, where it is no name, or taken. `what` names the kind
 * of thing in messages. */
struct binding *scope_declare(struct scope *scope, const struct node *at, const char *what);

/* The same for the index of a loop, which hides what else has that name, until scope_leave. */
struct binding *scope_enter(struct scope *scope, const struct node *at);
void scope_leave(struct scope *scope, struct binding *binding);

/* NULL where there is none. */
const struct binding *scope_find(const struct scope *scope, const char *name);

/* For arithmetic_evaluate; valid as long as the scope. */
struct arithmetic_names scope_names(struct scope *scope);

#endif
