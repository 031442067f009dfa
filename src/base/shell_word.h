/* shell_word.h: words of a command as a shell takes them. */
#ifndef BASE_SHELL_WORD_H
#define BASE_SHELL_WORD_H

#include <stdio.h>

/* Writes the word, in quotes unless it needs none. */
void shell_word_print(FILE *stream, const char *word);

#endif
