/* directive.h: what carries out the directives of a pbrt scene.
 *
 * Each file of directives has a table; directive.c looks words up in all of them. A directive
 * starts with parser.token on what follows its word, and takes what belongs to it.
 */
#ifndef PBRT_DIRECTIVE_H
#define PBRT_DIRECTIVE_H

#include "pbrt/parser.h"

struct call {
    struct parser *parser;
    struct importer *importer;
    const char *word;
    const struct origin *origin; /* of the word */
    int width;
};

enum where { ANYWHERE, BEFORE_WORLD, IN_WORLD };

struct directive {
    const char *word;
    enum where where;
    void (*run)(const struct call *call);
};

struct directive_table {
    const struct directive *rows;
    size_t count;
};

extern const struct directive_table directives_of_transforms; /* directive_transform.c */
extern const struct directive_table directives_of_levels;     /* directive_level.c */
extern const struct directive_table directives_of_statements; /* directive_statement.c */

/* Reports an error after which nothing can be read. */
void call_stop(const struct call *call, const char *message);
/* Numbers that follow, in brackets or not. False: reported. */
bool call_numbers(const struct call *call, double *numbers, size_t count);
/* A text in quotes that follows; to be freed. NULL: reported. */
char *call_text(const struct call *call);
/* Kind and parameters. False: reported, and the statement is empty. */
bool call_statement(const struct call *call, bool has_kind, struct statement *statement);

#endif
