/* parameter.h: one parameter that a scene declares. */
#ifndef PARSER_LANGUAGE_PARAMETER_H
#define PARSER_LANGUAGE_PARAMETER_H

#include "parser/language/assignment.h"
#include "parser/language/expand.h"
#include "parser/schema/schema_language.h"

struct parameter {
    enum schema_type type;       /* TYPE_AUTO where that was wrong, and reported */
    const struct node *fallback; /* its default, without formulas; NULL: there is none */
    const char *help;            /* or NULL */
    bool wrong;                  /* no declaration at all, which was reported */
};

/* A parameter that a scene declares, for lists of them; texts are valid during the call. */
struct psd_parameter {
    const char *name;
    const char *type;          /* "number", "vector" or "string" */
    const char *default_value; /* as text; NULL: it must be given */
    const char *help;          /* NULL: there is none */
};

/* Reads the declaration; what is wrong with it is reported. */
struct parameter parameter_read(struct expansion *expansion, const struct item *item);

/* What the command line gives, or else the default; a NODE_BROKEN where that was reported. */
const struct node *parameter_value(struct expansion *expansion, const struct item *item,
                                   const struct parameter *parameter,
                                   const struct assignments *given);

/* Reports what the command line gives and no parameter takes. */
void parameter_check_names(struct expansion *expansion, const struct node *parameters,
                           const struct assignments *given);

void parameter_list(const struct item *item, const struct parameter *parameter,
                    void (*each)(void *user, const struct psd_parameter *parameter), void *user);

#endif
