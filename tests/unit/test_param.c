/* test_param.c: every type of parameter: parsing, ranges, messages. For defaults and round trips
 * see test_param_table.c. */
#include "unit/param_fixture.h"

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
    accept(&values, "parts", "3.0");
    assert_true(values.parts.choice < 0 && values.parts.number == 3);
    refuse("parts", "2.5", "auto | full | integer 1..8");
}

/* With a choice, the number is 0: strategy.h's PS_FOOTPRINT_SETTINGS relies on it. */
static void test_choice_clears_the_number(void **state)
{
    (void)state;
    struct state values = {.size = {.number = 5, .choice = -1}};
    accept(&values, "size", "auto");
    assert_true(values.size.number == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bool),
        cmocka_unit_test(test_integer),
        cmocka_unit_test(test_large_integers),
        cmocka_unit_test(test_closed_and_open_ranges),
        cmocka_unit_test(test_vector),
        cmocka_unit_test(test_colour),
        cmocka_unit_test(test_string_is_a_copy),
        cmocka_unit_test(test_choices),
        cmocka_unit_test(test_choice_clears_the_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
