/* word.h: the numbers and names that the scene language's arithmetic is made of. */
#ifndef PARSER_LANGUAGE_WORD_H
#define PARSER_LANGUAGE_WORD_H

#include <stdbool.h>
#include <stddef.h>

/* Room for a name, and for a number as text. */
#define WORD_NAME 64
#define WORD_NUMBER 40

#define WORD_BLANKS " \t\n"

bool word_is_digit(char c);
bool word_is_letter(char c); /* also '_' */

/* How many characters from there on look like a number, or are a name. */
size_t word_number_length(const char *text);
size_t word_name_length(const char *text);

/* Copies a name; one that is too long is cut to one that nothing has. */
void word_copy_name(const char *text, size_t length, char name[WORD_NAME]);

/* Where the text is a name of fitting length and nothing else, but for blanks around it, copies
 * that name. */
bool word_is_name(const char *text, char name[WORD_NAME]);

/* Writes a number so that it reads back as the same one, whole numbers with all digits. */
void word_write_number(double value, char text[WORD_NUMBER]);

#endif
