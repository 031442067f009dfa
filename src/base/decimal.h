/* decimal.h: decimal numbers within long texts, quickly.
 *
 * strtod takes a hundred nanoseconds for a number, wants a zero after the text and the locale's
 * decimal point. Here up to 19 digits become an integer, which is multiplied or divided by a power
 * of ten (W. Clinger, "How to read floating point numbers accurately", 1990, the fast path). Up to
 * 15 digits and 22 decimals the result is the double next to the number; beyond, it is a few units
 * in the last place off, which a float hides.
 */
#ifndef BASE_DECIMAL_H
#define BASE_DECIMAL_H

#include <stdbool.h>

/* Reads "-1.5e3", ".5" or "+2" at *at, before `end`, and moves *at behind it; infinite where it is
 * out of range. False, and *at stays, where no number stands. */
bool decimal_read(const char **at, const char *end, double *value);

/* The same of a whole number, "-12"; false also beyond 18 digits. */
bool decimal_read_integer(const char **at, const char *end, long long *value);

#endif
