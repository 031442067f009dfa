/* words.c: see words.h. */
#include "pov/words.h"

#include "base/arena.h"
#include "writer/scene_text.h"
#include <stdlib.h>
#include <string.h>

static bool add(struct pov_words *words, const char *text)
{
    if (!scene_text_grow((void **)&words->texts, &words->capacity, words->count + 1,
                         sizeof *words->texts) ||
        !name_index_add(&words->index, name_index_hash(text)))
        return false;
    words->texts[words->count++] = text;
    return true;
}

bool pov_words_start(struct pov_words *words)
{
    static const char *const reserved[] = {
#define POV_WORD_TEXT(name) #name,
        POV_WORDS(POV_WORD_TEXT)
#undef POV_WORD_TEXT
    };
    for (size_t i = 0; i < POV_WORD_COUNT; i++)
        if (!add(words, reserved[i]))
            return false;
    return true;
}

void pov_words_release(struct pov_words *words)
{
    free(words->texts);
    name_index_release(&words->index);
    *words = (struct pov_words){0};
}

bool pov_words_number(struct pov_words *words, struct arena *arena, const char *text, size_t length,
                      uint32_t *number)
{
    char *copy = strndup(text, length);
    if (!copy)
        return false;
    size_t i = name_index_find(&words->index, name_index_hash(copy));
    while (i != NAME_INDEX_NONE && strcmp(words->texts[i], copy) != 0)
        i = name_index_before(&words->index, i);
    free(copy);
    *number = (uint32_t)(i == NAME_INDEX_NONE ? words->count : i);
    if (i != NAME_INDEX_NONE)
        return true;
    copy = words->count < UINT32_MAX ? arena_copy(arena, text, length) : NULL;
    return copy && add(words, copy);
}
