/* arithmetic.h: what a scalar such as `=2*pi/3` is worth.
 *
 *     sum     = product {("+" | "-") product}
 *     product = unary {("*" | "/") unary}
 *     unary   = ("+" | "-") unary | primary ["^" unary]        -2^2 is -4, 2^3^2 is 512
 *     primary = number | "pi" | "(" sum ")" | function "(" sum {"," sum} ")"
 *
 * Functions: sqrt sin cos tan (of radians) abs min max radians degrees.
 */
#ifndef PARSER_ARITHMETIC_H
#define PARSER_ARITHMETIC_H

#include "base/error.h"
#include <stddef.h>

/* Evaluates the text (without its '='). On an error `position` is the byte that it is about. */
ps_result arithmetic_evaluate(const char *text, double *value, size_t *position,
                              struct error *error);

#endif
