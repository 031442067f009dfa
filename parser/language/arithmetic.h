/* arithmetic.h: what a scalar such as `=2*pi/3` is worth.
 *
 *     value   = sum [("<" | "<=" | ">" | ">=" | "==" | "!=") sum]    1 where it holds, else 0
 *     sum     = product {("+" | "-") product}
 *     product = unary {("*" | "/") unary}
 *     unary   = ("+" | "-") unary | primary ["^" unary]              -2^2 is -4, 2^3^2 is 512
 *     primary = number | "pi" | name ["." component] | "(" value ")"
 *             | function "(" value {"," value} ")"
 *     name    = letter {letter | digit}, letters and "_"
 *
 * Functions are those of function.h.
 */
#ifndef PARSER_LANGUAGE_ARITHMETIC_H
#define PARSER_LANGUAGE_ARITHMETIC_H

#include "base/error.h"
#include "base/suggestion.h"
#include <stdbool.h>

enum arithmetic_found { ARITHMETIC_FOUND, ARITHMETIC_UNKNOWN, ARITHMETIC_WRONG };

/* The names that a text may use beyond pi and the functions. */
struct arithmetic_names {
    void *user;
    /* Finds a number, or component 0, 1 or 2 of a vector (-1: none was asked for). Fills the error
     * where the name can't be used so; with an empty message where that was reported already. */
    enum arithmetic_found (*find)(void *user, const char *name, int component, double *value,
                                  struct error *error);
    void (*suggest)(void *user, struct suggestion *suggestion);
};

/* Evaluates the text (without its '='); `names` may be NULL. On an error `position` is the byte
 * that it is about. */
ps_result arithmetic_evaluate(const char *text, const struct arithmetic_names *names, double *value,
                              size_t *position, struct error *error);

/* Whether the arithmetic has taken the name, which has another meaning there. */
bool arithmetic_is_reserved(const char *name);

#endif
