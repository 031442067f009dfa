/* statement.h: a directive of a pbrt scene with its parameter list.
 *
 *     Shape "sphere" "float radius" [ 2 ]
 *
 * A parameter is `"TYPE NAME"` and a value, or several in brackets (pbrt-v4 file format, "Parameter
 * lists"). A lookup names the type that it wants; a parameter of another type is an error. What no
 * lookup asked for is reported by statement_report_unused: so nothing is left out in silence.
 * pbrt-v4's Attribute directive gives parameters to all later statements of a kind; a statement's
 * own go before those.
 */
#ifndef PBRT_STATEMENT_H
#define PBRT_STATEMENT_H

#include "pbrt/lexer.h"
#include "writer/transform.h"
#include <stddef.h>

enum value_kind { VALUE_NUMBER, VALUE_STRING, VALUE_BOOL };

/* A type that may stand before a parameter's name. */
struct parameter_type {
    const char *name;
    enum value_kind kind;
    size_t width; /* numbers in one value; 0: any */
};

struct parameter {
    const struct parameter_type *type;
    char *name;      /* owned */
    double *numbers; /* owned; of bools 0 and 1 */
    char **strings;  /* owned, each too */
    size_t count;    /* of either */
    struct origin origin;
    int width;
    bool used;
};

/* Whether its type is called that. */
bool parameter_is(const struct parameter *parameter, const char *type);

/* Zeroed: empty. */
struct statement {
    const char *directive; /* as written, in the table of directives */
    char *kind;            /* owned; "sphere"; NULL where the directive takes none */
    struct parameter *parameters;
    size_t count, capacity;
    const struct attributes *attributes; /* NULL: none */
    size_t textures;                     /* how many were defined before */
    bool of_numbers;                     /* of a Texture: its type is float */
    struct origin origin;
    int width;
};

/* What an Attribute directive said; lists share their tails. */
struct attributes {
    const struct statement *statement;
    const struct attributes *next; /* what was said before */
};

struct importer;

/* Reads parameters up to the first token that begins none, which it leaves in *token. False:
 * reported. */
bool statement_read(struct importer *importer, struct lexer *lexer, struct token *token,
                    struct statement *statement);
void statement_release(struct statement *statement);

/* "TYPE NAME" for messages of errors: the place of the parameter, or of the statement. */
struct place {
    const struct origin *origin;
    int width;
};
struct place statement_place(const struct statement *statement, const struct parameter *parameter);

/* NULL where the statement has none of that name; marks it as used. */
struct parameter *statement_find(const struct statement *statement, const char *name);

/* One value each, or the default where there is none. Errors are reported, and give the default. */
double statement_number(struct importer *importer, const struct statement *statement,
                        const char *name, double otherwise);
long statement_integer(struct importer *importer, const struct statement *statement,
                       const char *name, long otherwise, long least, long most);
bool statement_bool(struct importer *importer, const struct statement *statement, const char *name,
                    bool otherwise);
/* NULL where there is none. */
const char *statement_string(struct importer *importer, const struct statement *statement,
                             const char *name);
struct vector statement_vector(struct importer *importer, const struct statement *statement,
                               const char *name, struct vector otherwise);

/* A list of values, each of `width` numbers; NULL where there is none, or where that is an
 * error. */
const double *statement_list(struct importer *importer, const struct statement *statement,
                             const char *name, size_t width, size_t *count);

/* Parameters that have no effect on what psplat shows, and need no warning. */
void statement_ignore(const struct statement *statement, const char *const *names, size_t count);

/* Warns of what was not used, once for each directive, kind and name. */
void statement_report_unused(struct importer *importer, const struct statement *statement);

#endif
