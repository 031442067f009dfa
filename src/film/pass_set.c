#include "film/pass_set.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void pass_set_release(struct pass_set *set)
{
    free(set->runs);
    *set = (struct pass_set){.runs = NULL};
}

static ps_result reserve(struct pass_set *set, size_t count, struct error *error)
{
    if (count <= set->capacity)
        return PS_OK;
    size_t capacity = 2 * count;
    struct pass_run *runs = realloc(set->runs, capacity * sizeof *runs);
    if (!runs)
        return error_memory(error, capacity * sizeof *runs, "numbers of passes");
    set->runs = runs;
    set->capacity = capacity;
    return PS_OK;
}

static void remove_run(struct pass_set *set, size_t i)
{
    memmove(set->runs + i, set->runs + i + 1, (set->count - i - 1) * sizeof *set->runs);
    set->count--;
}

ps_result pass_set_add(struct pass_set *set, uint32_t first, uint32_t end, struct error *error)
{
    size_t i = 0;
    if (first >= end)
        return PS_OK;
    ps_result result = reserve(set, set->count + 1, error);
    if (result != PS_OK)
        return result;
    while (i < set->count && set->runs[i].end <= first)
        i++;
    assert(i == set->count || end <= set->runs[i].first);
    memmove(set->runs + i + 1, set->runs + i, (set->count - i) * sizeof *set->runs);
    set->runs[i] = (struct pass_run){first, end};
    set->count++;
    if (i + 1 < set->count && set->runs[i + 1].first == end) {
        set->runs[i].end = set->runs[i + 1].end;
        remove_run(set, i + 1);
    }
    if (i > 0 && set->runs[i - 1].end == first) {
        set->runs[i - 1].end = set->runs[i].end;
        remove_run(set, i);
    }
    return PS_OK;
}

ps_result pass_set_add_all(struct pass_set *set, const struct pass_set *other, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < other->count && result == PS_OK; i++)
        result = pass_set_add(set, other->runs[i].first, other->runs[i].end, error);
    return result;
}

bool pass_set_has(const struct pass_set *set, uint32_t number)
{
    bool has = false;
    for (size_t i = 0; i < set->count; i++)
        has |= set->runs[i].first <= number && number < set->runs[i].end;
    return has;
}

bool pass_set_meets(const struct pass_set *a, const struct pass_set *b, uint32_t *number)
{
    for (size_t i = 0, j = 0; i < a->count && j < b->count;) {
        struct pass_run x = a->runs[i], y = b->runs[j];
        *number = x.first > y.first ? x.first : y.first;
        if (*number < x.end && *number < y.end)
            return true;
        i += x.end <= y.end;
        j += y.end <= x.end;
    }
    return false;
}

bool pass_set_same(const struct pass_set *a, const struct pass_set *b)
{
    bool same = a->count == b->count;
    for (size_t i = 0; i < a->count && same; i++)
        same = a->runs[i].first == b->runs[i].first && a->runs[i].end == b->runs[i].end;
    return same;
}

uint32_t pass_set_next_missing(const struct pass_set *set, uint32_t first)
{
    for (size_t i = 0; i < set->count; i++)
        if (set->runs[i].first <= first && first < set->runs[i].end)
            first = set->runs[i].end;
    return first;
}

uint32_t pass_set_size(const struct pass_set *set)
{
    uint32_t size = 0;
    for (size_t i = 0; i < set->count; i++)
        size += set->runs[i].end - set->runs[i].first;
    return size;
}

uint32_t pass_set_odd_size(const struct pass_set *set)
{
    uint32_t size = 0;
    for (size_t i = 0; i < set->count; i++)
        size += set->runs[i].end / 2 - set->runs[i].first / 2;
    return size;
}

#define RUN_LENGTH 24 /* of its text, at most */

char *pass_set_format(const struct pass_set *set)
{
    size_t bytes = set->count * RUN_LENGTH + 1, length = 0;
    char *text = malloc(bytes);
    if (!text)
        return NULL;
    text[0] = '\0';
    for (size_t i = 0; i < set->count; i++)
        length += (size_t)snprintf(text + length, bytes - length, "%s%" PRIu32 ":%" PRIu32,
                                   i > 0 ? "," : "", set->runs[i].first, set->runs[i].end);
    return text;
}

/* Reads a number and moves past it. */
static bool take_number(const char **text, uint32_t *number)
{
    uint64_t value = 0;
    const char *start = *text;
    for (; **text >= '0' && **text <= '9' && value <= UINT32_MAX; ++*text)
        value = 10 * value + (uint64_t)(**text - '0');
    *number = (uint32_t)value;
    return *text > start && value <= UINT32_MAX;
}

ps_result pass_set_parse(const char *text, struct pass_set *set, struct error *error)
{
    ps_result result = PS_OK;
    const char *rest = text;
    uint32_t before = 0;
    while (*rest && result == PS_OK) {
        uint32_t first, end;
        bool good = take_number(&rest, &first) && *rest++ == ':' && take_number(&rest, &end) &&
                    (rest[0] == '\0' || (rest[0] == ',' && rest[1] != '\0')) && before <= first &&
                    first < end;
        if (!good)
            return error_set(error, PS_ERROR_INVALID,
                             "expected runs of passes, such as 0:4,8:12, got '%.100s'", text);
        rest += *rest == ',';
        before = end;
        result = pass_set_add(set, first, end, error);
    }
    return result;
}
