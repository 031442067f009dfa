#include "base/param.h"

#include "base/text.h"
#include <assert.h>
#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_SCALAR 128

const ps_param *param_row(const struct param_table *table, size_t index)
{
    assert(index < table->count);
    return (const ps_param *)(const void *)((const char *)table->rows + index * table->stride);
}

const ps_param *param_find(const struct param_table *table, const char *name)
{
    for (size_t i = 0; i < table->count; i++) {
        const ps_param *row = param_row(table, i);
        if (strcmp(row->name, name) == 0)
            return row;
    }
    return NULL;
}

struct suggestion param_suggest(const struct param_table *table, const char *name)
{
    struct suggestion suggestion = suggestion_start(name);
    for (size_t i = 0; i < table->count; i++)
        suggestion_consider(&suggestion, param_row(table, i)->name);
    return suggestion;
}

static ps_result reject(const ps_param *row, const char *text, struct error *error)
{
    char domain[256];
    param_describe_domain(row, domain, sizeof domain);
    return error_set(error, PS_ERROR_INVALID, "expected %s, got '%.80s'", domain, text);
}

/* Whether the row's numbers are whole ones. */
static bool is_whole(const ps_param *row)
{
    return row->type == PS_PARAM_INT || row->flags & PS_PARAM_WHOLE;
}

static bool in_range(const ps_param *row, double value)
{
    if (is_whole(row) && value != floor(value))
        return false;
    if (row->flags & PS_PARAM_OPEN_MIN ? value <= row->minimum : value < row->minimum)
        return false;
    return row->flags & PS_PARAM_OPEN_MAX ? value < row->maximum : value <= row->maximum;
}

static bool parse_number(const ps_param *row, const char *text, double *value)
{
    return text_to_number(text, value) && in_range(row, *value);
}

static bool parse_integer(const ps_param *row, const char *text, int64_t *value)
{
    double number;
    /* Beyond 2^53 a double no longer counts in ones. */
    if (!parse_number(row, text, &number) || number < -9007199254740992.0 ||
        number > 9007199254740992.0)
        return false;
    *value = (int64_t)number;
    return true;
}

static bool parse_bool(const char *text, int32_t *value)
{
    static const char *const words[] = {"no", "yes", "false", "true", "off", "on", "0", "1"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcmp(text, words[i]) == 0) {
            *value = (int32_t)(i % 2);
            return true;
        }
    return false;
}

static bool parse_choice(const ps_param *row, const char *text, int32_t *value)
{
    for (int32_t i = 0; row->choices[i]; i++)
        if (strcmp(row->choices[i], text) == 0) {
            *value = i;
            return true;
        }
    return false;
}

static const char *skip_spaces(const char *p)
{
    while (isspace((unsigned char)*p))
        p++;
    return p;
}

/* Copies the next item of "[a, b, c]" and returns where the text goes on after it, or NULL. */
static const char *next_item(const char *p, char item[LONGEST_SCALAR])
{
    p = skip_spaces(p);
    size_t length = strcspn(p, ",] \t\n");
    if (length == 0 || length >= LONGEST_SCALAR)
        return NULL;
    memcpy(item, p, length);
    item[length] = '\0';
    return skip_spaces(p + length);
}

static bool parse_triple(const ps_param *row, const char *text, float triple[3])
{
    const char *p = skip_spaces(text);
    if (*p++ != '[')
        return false;
    for (int i = 0; i < 3; i++) {
        char item[LONGEST_SCALAR];
        double value;
        p = next_item(p, item);
        if (!p || !parse_number(row, item, &value) || *p++ != (i < 2 ? ',' : ']'))
            return false;
        triple[i] = (float)value;
        if (!isfinite(triple[i]))
            return false;
    }
    return *skip_spaces(p) == '\0';
}

static bool parse_color(const ps_param *row, const char *text, float triple[3])
{
    double grey;
    if (!parse_number(row, text, &grey))
        return parse_triple(row, text, triple);
    triple[0] = triple[1] = triple[2] = (float)grey;
    return isfinite(triple[0]);
}

static bool parse_number_or_choice(const ps_param *row, const char *text,
                                   ps_number_or_choice *value)
{
    ps_number_or_choice parsed = {.number = 0, .choice = -1};
    if (!parse_choice(row, text, &parsed.choice) && !parse_number(row, text, &parsed.number))
        return false;
    *value = parsed;
    return true;
}

static ps_result store_string(char **member, const char *text, struct error *error)
{
    size_t bytes = strlen(text) + 1;
    char *copy = malloc(bytes);
    if (!copy)
        return error_memory(error, bytes, "a parameter");
    memcpy(copy, text, bytes);
    free(*member);
    *member = copy;
    return PS_OK;
}

ps_result param_set(const ps_param *row, void *state, const char *text, struct error *error)
{
    void *member = (char *)state + row->offset;
    bool good = false;
    float triple[3];
    switch ((ps_param_type)row->type) {
    case PS_PARAM_BOOL:
        good = parse_bool(text, member);
        break;
    case PS_PARAM_INT:
        good = parse_integer(row, text, member);
        break;
    case PS_PARAM_NUMBER: {
        double number;
        good = parse_number(row, text, &number);
        if (good)
            memcpy(member, &number, sizeof number);
        break;
    }
    case PS_PARAM_VEC3:
    case PS_PARAM_COLOR:
        good = row->type == PS_PARAM_VEC3 ? parse_triple(row, text, triple)
                                          : parse_color(row, text, triple);
        if (good)
            memcpy(member, triple, sizeof triple);
        break;
    case PS_PARAM_STRING:
        return store_string(member, text, error);
    case PS_PARAM_CHOICE:
        good = parse_choice(row, text, member);
        break;
    case PS_PARAM_NUMBER_OR_CHOICE:
        good = parse_number_or_choice(row, text, member);
        break;
    }
    return good ? PS_OK : reject(row, text, error);
}

static void scale(const ps_param *row, void *state, double effort)
{
    int64_t *member = (int64_t *)(void *)((char *)state + row->offset);
    double number = round(effort * (double)*member);
    *member = (int64_t)fmin(fmax(number, row->minimum), row->maximum);
}

ps_result param_set_defaults(const struct param_table *table, void *state, double effort,
                             struct error *error)
{
    for (size_t i = 0; i < table->count; i++) {
        const ps_param *row = param_row(table, i);
        ps_result result =
            row->default_value ? param_set(row, state, row->default_value, error) : PS_OK;
        if (result != PS_OK)
            return result;
        if (row->type == PS_PARAM_INT && row->flags & PS_PARAM_QUALITY)
            scale(row, state, effort);
    }
    return PS_OK;
}

void param_release(const struct param_table *table, void *state)
{
    for (size_t i = 0; i < table->count; i++) {
        const ps_param *row = param_row(table, i);
        if (row->type == PS_PARAM_STRING) {
            char **member = (char **)(void *)((char *)state + row->offset);
            free(*member);
            *member = NULL;
        }
    }
}

static void format_triple(const void *member, char *text, size_t size)
{
    float triple[3];
    memcpy(triple, member, sizeof triple);
    char parts[3][32];
    for (int i = 0; i < 3; i++)
        text_from_float(triple[i], parts[i], sizeof parts[i]);
    snprintf(text, size, "[%s, %s, %s]", parts[0], parts[1], parts[2]);
}

void param_format(const ps_param *row, const void *state, char *text, size_t size)
{
    const void *member = (const char *)state + row->offset;
    const ps_number_or_choice *either = member;
    switch ((ps_param_type)row->type) {
    case PS_PARAM_BOOL:
        snprintf(text, size, "%s", *(const int32_t *)member ? "yes" : "no");
        break;
    case PS_PARAM_INT:
        snprintf(text, size, "%" PRId64, *(const int64_t *)member);
        break;
    case PS_PARAM_NUMBER:
        text_from_number(*(const double *)member, text, size);
        break;
    case PS_PARAM_VEC3:
    case PS_PARAM_COLOR:
        format_triple(member, text, size);
        break;
    case PS_PARAM_STRING:
        snprintf(text, size, "%s", *(const char *const *)member);
        break;
    case PS_PARAM_CHOICE:
        snprintf(text, size, "%s", row->choices[*(const int32_t *)member]);
        break;
    case PS_PARAM_NUMBER_OR_CHOICE:
        if (either->choice < 0)
            text_from_number(either->number, text, size);
        else
            snprintf(text, size, "%s", row->choices[either->choice]);
        break;
    }
}

/* "number", "number > 0", "integer 1..64", "number >= 0", "number 0..1 (0 excluded)" */
static void describe_range(const ps_param *row, const char *noun, char *text, size_t size)
{
    bool open_min = row->flags & PS_PARAM_OPEN_MIN, open_max = row->flags & PS_PARAM_OPEN_MAX;
    bool has_min = isfinite(row->minimum), has_max = isfinite(row->maximum);
    char low[32], high[32];
    if (is_whole(row)) {
        snprintf(low, sizeof low, "%.0f", row->minimum);
        snprintf(high, sizeof high, "%.0f", row->maximum);
    } else {
        text_from_number(row->minimum, low, sizeof low);
        text_from_number(row->maximum, high, sizeof high);
    }
    if (has_min && has_max && (open_min || open_max))
        snprintf(text, size, "%s %s..%s (%s%s%s excluded)", noun, low, high, open_min ? low : "",
                 open_min && open_max ? " and " : "", open_max ? high : "");
    else if (has_min && has_max)
        snprintf(text, size, "%s %s..%s", noun, low, high);
    else if (has_min)
        snprintf(text, size, "%s %s %s", noun, open_min ? ">" : ">=", low);
    else if (has_max)
        snprintf(text, size, "%s %s %s", noun, open_max ? "<" : "<=", high);
    else
        snprintf(text, size, "%s", noun);
}

static size_t describe_choices(const ps_param *row, char *text, size_t size)
{
    size_t used = 0;
    for (size_t i = 0; row->choices[i] && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? " | " : "", row->choices[i]);
    return used < size ? used : size - 1;
}

void param_describe_domain(const ps_param *row, char *text, size_t size)
{
    size_t used;
    switch ((ps_param_type)row->type) {
    case PS_PARAM_BOOL:
        snprintf(text, size, "yes | no");
        break;
    case PS_PARAM_INT:
        describe_range(row, "integer", text, size);
        break;
    case PS_PARAM_NUMBER:
        describe_range(row, is_whole(row) ? "integer" : "number", text, size);
        break;
    case PS_PARAM_VEC3:
        describe_range(row, "[x, y, z] of number", text, size);
        break;
    case PS_PARAM_COLOR:
        describe_range(row, "[r, g, b] or grey, each number", text, size);
        break;
    case PS_PARAM_STRING:
        snprintf(text, size, "text");
        break;
    case PS_PARAM_CHOICE:
        describe_choices(row, text, size);
        break;
    case PS_PARAM_NUMBER_OR_CHOICE:
        used = describe_choices(row, text, size);
        used += (size_t)snprintf(text + used, size - used, " | ");
        if (used < size)
            describe_range(row, is_whole(row) ? "integer" : "number", text + used, size - used);
        break;
    }
}
