/* shell_word.h: words of a command as a shell takes them. */
#ifndef BASE_SHELL_WORD_H
#define BASE_SHELL_WORD_H

#include <stdio.h>

/* Writes the word, in quotes unless it needs none. */
void shell_word_print(FILE *stream, const char *word);

/* The same for a path, which must not look like an option: "./-x.psd". Standard input, "-", is
 * none. */
void shell_word_print_path(FILE *stream, const char *path);

#endif
