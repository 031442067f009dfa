/* suggestion.c: keeps the nearest of the candidates; the first one wins a tie. */
#include "base/suggestion.h"

#include "base/text.h"
#include <stdio.h>

struct suggestion suggestion_start(const char *word)
{
    return (struct suggestion){.word = word};
}

void suggestion_consider(struct suggestion *suggestion, const char *candidate)
{
    if (!text_is_near(suggestion->word, candidate))
        return;
    size_t distance = text_distance(suggestion->word, candidate);
    if (!suggestion->best || distance < suggestion->distance) {
        suggestion->best = candidate;
        suggestion->distance = distance;
    }
}

void suggestion_text(const struct suggestion *suggestion, char text[SUGGESTION_TEXT])
{
    text[0] = '\0';
    if (suggestion->best)
        snprintf(text, SUGGESTION_TEXT, "; did you mean '%.100s'?", suggestion->best);
}
