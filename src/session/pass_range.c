#include "session/pass_range.h"

#include "session/option_value.h"
#include <stdio.h>
#include <string.h>

ps_result pass_range_parse(const char *text, struct pass_range *range, struct error *error)
{
    const char *colon = strchr(text, ':');
    char before[32];
    double first = 0, end = 0;
    if (colon) {
        snprintf(before, sizeof before, "%.*s", (int)(colon - text < 31 ? colon - text : 31), text);
        ps_result result = option_whole_number("passes", before, 0, MOST_PASSES - 1, &first, error);
        if (result != PS_OK)
            return result;
    }
    ps_result result = option_whole_number("passes", colon ? colon + 1 : text, first + 1,
                                           MOST_PASSES, &end, error);
    if (result == PS_OK)
        *range = (struct pass_range){true, colon != NULL, (uint32_t)first, (uint32_t)end};
    return result;
}
