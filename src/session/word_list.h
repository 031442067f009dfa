/* word_list.h: a growing list of words. */
#ifndef SESSION_WORD_LIST_H
#define SESSION_WORD_LIST_H

#include "base/error.h"

/* Zeroed: empty. */
struct word_list {
    char **words; /* owned, as the words are */
    size_t count;
};

/* Copies a word to the place `index` <= count; those from there on move up. PS_ERROR_MEMORY. */
ps_result word_list_insert(struct word_list *list, size_t index, const char *word,
                           struct error *error);

/* Frees and empties it. */
void word_list_release(struct word_list *list);

/* Replaces a word by a copy of another. PS_ERROR_MEMORY. */
ps_result word_replace(char **word, const char *other, struct error *error);

#endif
