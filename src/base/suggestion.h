/* suggestion.h: finds the name that a misspelt word most likely meant. */
#ifndef BASE_SUGGESTION_H
#define BASE_SUGGESTION_H

#include <stddef.h>

struct suggestion {
    const char *word;
    const char *best; /* NULL: nothing near enough was considered */
    size_t distance;
};

/* Room for "; did you mean 'NAME'?" */
#define SUGGESTION_TEXT 128

struct suggestion suggestion_start(const char *word);
void suggestion_consider(struct suggestion *suggestion, const char *candidate);

/* Writes "; did you mean 'NAME'?", or nothing where nothing was near. */
void suggestion_text(const struct suggestion *suggestion, char text[SUGGESTION_TEXT]);

#endif
