/* expression.h: numbers, vectors, colours and texts (reference of POV-Ray 3.7, "Language Basics").
 *
 * A float that meets a vector counts for each of its terms, and a short vector gets zeros.
 * Comparisons and logic stand in parentheses, or where a whole value is read, since < also opens
 * vectors. Errors are reported; the result is then 0.
 */
#ifndef POV_EXPRESSION_H
#define POV_EXPRESSION_H

#include "pov/reader.h"

/* Whether an expression begins with that token. */
bool pov_begins_number(const struct pov_reader *reader, const struct pov_token *token);
bool pov_begins_string(const struct pov_reader *reader, const struct pov_token *token);

struct pov_number pov_read_number(struct pov_reader *reader);
/* The same with comparisons, logic and ?: outside of parentheses. */
struct pov_number pov_read_condition(struct pov_reader *reader);
/* Terms 0..2 the colour, then filter and transmit. */
struct pov_number pov_read_color(struct pov_reader *reader);
double pov_read_float(struct pov_reader *reader);
struct vector pov_read_vector(struct pov_reader *reader);
/* In the arena; NULL: reported. */
const char *pov_read_string(struct pov_reader *reader);
/* "(value)" */
double pov_read_parenthesis(struct pov_reader *reader);

/* Reads a float where there is one. */
double pov_read_optional(struct pov_reader *reader, double otherwise);
/* A comma, which may be missing in many places. */
void pov_skip_comma(struct pov_reader *reader);

/* A function of POV-Ray's behind its name: sin(...), vcross(...) (function.c); false: it is
 * none. */
bool pov_read_function(struct pov_reader *reader, const struct pov_token *token,
                       struct pov_number *result);
bool pov_is_function(uint32_t word);

/* What a name stands for, with "[i]" where that is an array of what is no number, text or array.
 * NULL: nothing, or reported. */
struct pov_value *pov_named(struct pov_reader *reader, const struct pov_token *token);
/* Any value that can be declared or be an argument (rvalue.c); POV_VALUE_NONE: reported. */
struct pov_value pov_read_value(struct pov_reader *reader);

/* The next of a stream of rand(): next = next * 1812433253 + 12345 in 32 bits, 0..1. */
double pov_random(uint32_t *stream);

#endif
