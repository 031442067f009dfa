/* text.h: text helpers that the C library lacks or ties to the locale. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* Reads a whole decimal number ("-1.5e3", ".5", "+2") with '.' whatever the locale says. No
 * hexadecimal, inf or nan; false where anything else stands in the text, or the value overflows. */
bool text_to_number(const char *text, double *value);

/* The same of the first `length` characters, of which there may be 63. */
bool text_part_to_number(const char *text, size_t length, double *value);

/* Write the shortest decimal text, of a few precisions, that reads back as the same value. */
void text_from_number(double value, char *text, size_t size);
void text_from_float(float value, char *text, size_t size);

/* Bytes of memory for people: "1.5 GiB", "640 MiB". Returns `text`. */
#define TEXT_SIZE_LENGTH 32
const char *text_of_size(double bytes, char text[TEXT_SIZE_LENGTH]);

/* Gives a number that printf wrote the decimal point '.'. */
void text_delocalize(char *text);

/* Whether it ends in that, with something before it. */
bool text_has_suffix(const char *text, const char *suffix);

/* Optimal string alignment distance (Damerau-Levenshtein without repeated edits), for did-you-mean.
 */
size_t text_distance(const char *a, const char *b);

/* Whether `candidate` is near enough to `word` to be offered as what was meant. */
bool text_is_near(const char *word, const char *candidate);

#endif
