#include "session/word_list.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

ps_result word_replace(char **word, const char *other, struct error *error)
{
    char *copy = strdup(other);
    if (!copy)
        return error_memory(error, strlen(other) + 1, "an option");
    free(*word);
    *word = copy;
    return PS_OK;
}

ps_result word_list_insert(struct word_list *list, size_t index, const char *word,
                           struct error *error)
{
    assert(index <= list->count);
    char *copy = NULL;
    ps_result result = word_replace(&copy, word, error);
    if (result != PS_OK)
        return result;
    size_t bytes = (list->count + 1) * sizeof *list->words;
    char **words = realloc(list->words, bytes);
    if (!words) {
        free(copy);
        return error_memory(error, bytes, "options");
    }
    memmove(words + index + 1, words + index, (list->count - index) * sizeof *words);
    words[index] = copy;
    list->words = words;
    list->count++;
    return PS_OK;
}

void word_list_release(struct word_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->words[i]);
    free(list->words);
    *list = (struct word_list){0};
}
