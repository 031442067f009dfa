/* test_param.c: every type of parameter: parsing, ranges, messages, defaults, round trips. */
#include "base/param.h"

#include "support/random.h"
#include <psplat/math.h>
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
    ps_number_or_choice size;
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
};

static const struct param_table table = {rows, sizeof rows / sizeof rows[0], sizeof rows[0]};

static ps_result set(struct state *values, const char *name, const char *text, struct error *error)
{
    const ps_param *row = param_find(&table, name);
    assert_non_null(row);
    return param_set(row, values, text, error);
}

static void accept(struct state *values, const char *name, const char *text)
{
    struct error error = {""};
    if (set(values, name, text, &error) != PS_OK)
        fail_msg("%s=%s: %s", name, text, error.text);
}

/* The text is refused with that message, and the state stays as it was. */
static void refuse(const char *name, const char *text, const char *domain)
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

static void test_defaults(void **state)
{
    (void)state;
    struct state values = {.above = 99};
    struct error error;
    assert_int_equal(param_set_defaults(&table, &values, &error), PS_OK);
    assert_int_equal(values.flag, 1);
    assert_true(values.count == 7);
    assert_true(values.number == 0.5 && values.open == 0.25 && values.below == -1);
    assert_true(values.above == 99); /* required: no default */
    assert_true(values.place.x == 1 && values.place.y == 2 && values.place.z == 3);
    assert_true(values.tint.r == 0.5f && values.tint.g == 0.5f && values.tint.b == 0.5f);
    assert_string_equal(values.label, "none");
    assert_int_equal(values.mode, 1);
    assert_int_equal(values.size.choice, 0);
    param_release(&table, &values);
    assert_null(values.label);
}

static void test_bad_default_is_reported(void **state)
{
    (void)state;
    const ps_param bad[] = {PS_INT(struct state, count, "100", 1, 64, "", "out of its own range")};
    const struct param_table bad_table = {bad, 1, sizeof bad[0]};
    struct state values = {0};
    struct error error;
    assert_int_equal(param_set_defaults(&bad_table, &values, &error), PS_ERROR_INVALID);
    assert_string_equal(error.text, "expected integer 1..64, got '100'");
}

static void test_bool(void **state)
{
    (void)state;
    static const char *const yes[] = {"yes", "true", "on", "1"};
    static const char *const no[] = {"no", "false", "off", "0"};
    struct state values = {.flag = 5};
    for (int i = 0; i < 4; i++) {
        accept(&values, "flag", yes[i]);
        assert_int_equal(values.flag, 1);
        accept(&values, "flag", no[i]);
        assert_int_equal(values.flag, 0);
    }
    refuse("flag", "2", "yes | no");
    refuse("flag", "", "yes | no");
    refuse("flag", "yess", "yes | no");
}

static void test_integer(void **state)
{
    (void)state;
    struct state values = {0};
    accept(&values, "count", "1");
    assert_true(values.count == 1);
    accept(&values, "count", "64");
    assert_true(values.count == 64);
    accept(&values, "count", "1e1");
    assert_true(values.count == 10);
    accept(&values, "count", "3.0");
    assert_true(values.count == 3);
    refuse("count", "0", "integer 1..64");
    refuse("count", "65", "integer 1..64");
    refuse("count", "1.5", "integer 1..64");
    refuse("count", "ten", "integer 1..64");
    refuse("count", "", "integer 1..64");
}

static void test_large_integers(void **state)
{
    (void)state;
    const ps_param row = PS_INT(struct state, count, "0", -INFINITY, INFINITY, "", "any");
    struct state values = {0};
    struct error error;
    assert_int_equal(param_set(&row, &values, "9007199254740992", &error), PS_OK);
    assert_true(values.count == INT64_C(9007199254740992));
    assert_int_equal(param_set(&row, &values, "-9007199254740992", &error), PS_OK);
    assert_true(values.count == -INT64_C(9007199254740992));
    assert_int_equal(param_set(&row, &values, "1e17", &error), PS_ERROR_INVALID);
    assert_int_equal(param_set(&row, &values, "-1e300", &error), PS_ERROR_INVALID);
    assert_string_equal(error.text, "expected integer, got '-1e300'");
}

static void test_closed_and_open_ranges(void **state)
{
    (void)state;
    struct state values = {0};
    accept(&values, "number", "0");
    accept(&values, "number", "1");
    assert_true(values.number == 1);
    refuse("number", "-0.001", "number 0..1");
    refuse("number", "1.0000001", "number 0..1");
    accept(&values, "open", "1e-300");
    accept(&values, "open", "0.9999999999");
    refuse("open", "0", "number 0..1 (0 and 1 excluded)");
    refuse("open", "1", "number 0..1 (0 and 1 excluded)");
    accept(&values, "below", "-1e300");
    assert_true(values.below == -1e300);
    refuse("below", "0", "number < 0");
    accept(&values, "above", "2");
    refuse("above", "1.999", "number >= 2");
    refuse("above", "inf", "number >= 2");
    refuse("above", "nan", "number >= 2");
    refuse("above", "1e999", "number >= 2");
}

static void test_vector(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "",
        "1",
        "[1, 2]",
        "[1, 2, 3, 4]",
        "[1, 2, 3",
        "1, 2, 3]",
        "[1 2 3]",
        "[,1,2,3]",
        "[1,,2]",
        "[1,2,]",
        "[1, 2, 3]x",
        "[1, 2, x]",
        "[1, 2, inf]",
        "[[1,2,3]]",
        "(1,2,3)",
        "[1, 2, 1e39]",
        "[1, 2, 3}",
    };
    struct state values = {0};
    accept(&values, "place", "[4,-5.5,6e2]");
    assert_true(values.place.x == 4 && values.place.y == -5.5f && values.place.z == 600);
    accept(&values, "place", " [ 1 ,\t2,\n3 ] ");
    assert_true(values.place.x == 1 && values.place.y == 2 && values.place.z == 3);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        refuse("place", bad[i], "[x, y, z] of number");
}

static void test_colour(void **state)
{
    (void)state;
    const char *domain = "[r, g, b] or grey, each number 0..1";
    struct state values = {0};
    accept(&values, "tint", "[0, 0.5, 1]");
    assert_true(values.tint.r == 0 && values.tint.g == 0.5f && values.tint.b == 1);
    accept(&values, "tint", "0.125");
    assert_true(values.tint.r == 0.125f && values.tint.g == 0.125f && values.tint.b == 0.125f);
    refuse("tint", "1.5", domain);
    refuse("tint", "[0, 0.5, 1.5]", domain);
    refuse("tint", "[-0.1, 0.5, 1]", domain);
    refuse("tint", "white", domain);
}

static void test_string_is_a_copy(void **state)
{
    (void)state;
    struct state values = {.label = NULL};
    char text[] = "a, [b]";
    accept(&values, "label", text);
    text[0] = 'x';
    assert_string_equal(values.label, "a, [b]");
    accept(&values, "label", ""); /* the first copy must be freed: a leak check sees it */
    assert_string_equal(values.label, "");
    param_release(&table, &values);
}

static void test_choices(void **state)
{
    (void)state;
    struct state values = {0};
    accept(&values, "mode", "fast");
    assert_int_equal(values.mode, 0);
    accept(&values, "mode", "slow");
    assert_int_equal(values.mode, 1);
    refuse("mode", "Fast", "fast | slow");
    refuse("mode", "fas", "fast | slow");
    refuse("mode", "0", "fast | slow");
    accept(&values, "size", "full");
    assert_int_equal(values.size.choice, 1);
    accept(&values, "size", "2.5");
    assert_true(values.size.choice < 0 && values.size.number == 2.5);
    accept(&values, "size", "auto");
    assert_int_equal(values.size.choice, 0);
    refuse("size", "0", "auto | full | number > 0");
    refuse("size", "automatic", "auto | full | number > 0");
}

/* With a choice, the number is 0: strategy.h's PS_BOX_SETTINGS relies on it. */
static void test_choice_clears_the_number(void **state)
{
    (void)state;
    struct state values = {.size = {5, -1}};
    accept(&values, "size", "auto");
    assert_true(values.size.number == 0);
}

static void expect_round_trip(const char *name, const char *text)
{
    const ps_param *row = param_find(&table, name);
    struct state values = {0}, again = {0};
    struct error error;
    char formatted[256], twice[256];
    accept(&values, name, text);
    param_format(row, &values, formatted, sizeof formatted);
    assert_int_equal(param_set(row, &again, formatted, &error), PS_OK);
    param_format(row, &again, twice, sizeof twice);
    assert_string_equal(formatted, twice);
    param_release(&table, &values);
    param_release(&table, &again);
}

static void test_round_trips(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"flag", "on"},     {"flag", "off"},    {"count", "33"},  {"number", "0.1"},
        {"below", "-1e-9"}, {"label", "x=[y]"}, {"mode", "fast"}, {"mode", "slow"},
        {"size", "full"},   {"size", "auto"},   {"size", "3.25"}, {"above", "16777217"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        expect_round_trip(pairs[i][0], pairs[i][1]);
}

static void test_numbers_come_back_bitwise(void **state)
{
    (void)state;
    const ps_param *row = param_find(&table, "below"), *place = param_find(&table, "place");
    struct random random = {4};
    for (int i = 0; i < 20000; i++) {
        struct state values = {0}, again = {0};
        struct error error;
        char text[256];
        values.below = -random_unit(&random) * pow(10, i % 600 - 300) - 1e-306;
        values.place = ps_scale(random_direction(&random), powf(10, (float)(i % 60) - 30));
        param_format(row, &values, text, sizeof text);
        assert_int_equal(param_set(row, &again, text, &error), PS_OK);
        param_format(place, &values, text, sizeof text);
        assert_int_equal(param_set(place, &again, text, &error), PS_OK);
        assert_memory_equal(&values, &again, sizeof values);
    }
}

static void test_find_and_suggest(void **state)
{
    (void)state;
    assert_ptr_equal(param_find(&table, "tint"), &rows[7]);
    assert_null(param_find(&table, "tin"));
    assert_null(param_find(&table, ""));
    assert_string_equal(param_suggest(&table, "cuont"), "count");
    assert_string_equal(param_suggest(&table, "plaec"), "place");
    assert_string_equal(param_suggest(&table, "mod"), "mode"); /* the nearest */
    assert_null(param_suggest(&table, "photons"));
}

/* A plugin built with more members than psplat knows has longer rows. */
static void test_longer_rows(void **state)
{
    (void)state;
    struct {
        ps_param row;
        char more[24];
    } longer[2] = {{.row = rows[0]}, {.row = rows[1]}};
    const struct param_table wide = {&longer[0].row, 2, sizeof longer[0]};
    assert_ptr_equal(param_row(&wide, 1), &longer[1].row);
    assert_ptr_equal(param_find(&wide, "count"), &longer[1].row);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_bad_default_is_reported),
        cmocka_unit_test(test_bool),
        cmocka_unit_test(test_integer),
        cmocka_unit_test(test_large_integers),
        cmocka_unit_test(test_closed_and_open_ranges),
        cmocka_unit_test(test_vector),
        cmocka_unit_test(test_colour),
        cmocka_unit_test(test_string_is_a_copy),
        cmocka_unit_test(test_choices),
        cmocka_unit_test(test_choice_clears_the_number),
        cmocka_unit_test(test_round_trips),
        cmocka_unit_test(test_numbers_come_back_bitwise),
        cmocka_unit_test(test_find_and_suggest),
        cmocka_unit_test(test_longer_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
