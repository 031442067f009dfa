/* param_fixture.h: a table with a parameter of every type, and the state it fills. */
#ifndef TESTS_PARAM_FIXTURE_H
#define TESTS_PARAM_FIXTURE_H

#include "base/param.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const char *const modes[] = {"fast", "slow", NULL};
static const char *const sizes[] = {"auto", "full", NULL};

struct state {
    int32_t flag;
    int64_t count;
    double number, open, below, above;
    ps_vec3 place;
    ps_rgb tint;
    const char *label;
    int32_t mode;
    ps_number_or_choice size, parts;
};

static const ps_param rows[] = {
    PS_BOOL(struct state, flag, "yes", "a flag"),
    PS_INT(struct state, count, "7", 1, 64, "", "an integer"),
    PS_NUMBER(struct state, number, "0.5", 0, 1, 0, "m", "a closed range"),
    PS_NUMBER(struct state, open, "0.25", 0, 1, PS_PARAM_OPEN_MIN | PS_PARAM_OPEN_MAX, "", "open"),
    PS_NUMBER(struct state, below, "-1", -INFINITY, 0, PS_PARAM_OPEN_MAX, "", "negative"),
    PS_NUMBER(struct state, above, NULL, 2, INFINITY, 0, "", "required"),
    PS_VEC3(struct state, place, "[1, 2, 3]", "m", "a vector"),
    PS_COLOR(struct state, tint, "0.5", 0, 1, "", "a colour"),
    PS_STRING(struct state, label, "none", "a text"),
    PS_CHOICE(struct state, mode, "slow", modes, "a choice"),
    PS_NUMBER_OR(struct state, size, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN, sizes, "", "either"),
    PS_NUMBER_OR(struct state, parts, "auto", 1, 8, PS_PARAM_WHOLE, sizes, "",
                 "a whole one or a word"),
};

static const struct param_table table = {rows, sizeof rows / sizeof rows[0], sizeof rows[0]};

static inline ps_result set(struct state *values, const char *name, const char *text,
                            struct error *error)
{
    const ps_param *row = param_find(&table, name);
    assert_non_null(row);
    return param_set(row, values, text, error);
}

static inline void accept(struct state *values, const char *name, const char *text)
{
    struct error error = {""};
    if (set(values, name, text, &error) != PS_OK)
        fail_msg("%s=%s: %s", name, text, error.text);
}

/* The text is refused with that message, and the state stays as it was. */
static inline void refuse(const char *name, const char *text, const char *domain)
{
    struct state values, before;
    struct error error = {""};
    char expected[512];
    memset(&values, 0x5a, sizeof values);
    memcpy(&before, &values, sizeof values);
    if (set(&values, name, text, &error) != PS_ERROR_INVALID)
        fail_msg("%s=%s was taken", name, text);
    snprintf(expected, sizeof expected, "expected %s, got '%s'", domain, text);
    assert_string_equal(error.text, expected);
    assert_memory_equal(&values, &before, sizeof values);
}

#endif
