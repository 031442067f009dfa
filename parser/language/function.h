/* function.h: the functions of the scene language's arithmetic. */
#ifndef PARSER_LANGUAGE_FUNCTION_H
#define PARSER_LANGUAGE_FUNCTION_H

#include "base/suggestion.h"
#include <stdbool.h>

#define FUNCTION_MOST_ARGUMENTS 8

/* One of `unary`, `binary` and `any` is set. */
struct function {
    const char *name;
    size_t fewest, most; /* arguments */
    double (*unary)(double);
    double (*binary)(double, double);
    double (*any)(const double *arguments, size_t count);
};

/* NULL where there is none of that name. */
const struct function *function_find(const char *name);

/* The value for as many arguments as the function takes; may be infinite or not a number. */
double function_apply(const struct function *function, const double *arguments, size_t count);

void function_suggest(struct suggestion *suggestion);

#endif
