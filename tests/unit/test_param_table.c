/* test_param_table.c: tables of parameters: defaults, names, and values written and read back. */
#include "support/random.h"
#include "unit/param_fixture.h"
#include <psplat/math.h>

static void test_defaults(void **state)
{
    (void)state;
    struct state values = {.above = 99};
    struct error error;
    assert_int_equal(param_set_defaults(&table, &values, 1.0, &error), PS_OK);
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
    assert_int_equal(param_set_defaults(&bad_table, &values, 1.0, &error), PS_ERROR_INVALID);
    assert_string_equal(error.text, "expected integer 1..64, got '100'");
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
    assert_string_equal(param_suggest(&table, "cuont").best, "count");
    assert_string_equal(param_suggest(&table, "plaec").best, "place");
    assert_string_equal(param_suggest(&table, "mod").best, "mode"); /* the nearest */
    assert_null(param_suggest(&table, "photons").best);
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
        cmocka_unit_test(test_defaults),         cmocka_unit_test(test_bad_default_is_reported),
        cmocka_unit_test(test_round_trips),      cmocka_unit_test(test_numbers_come_back_bitwise),
        cmocka_unit_test(test_find_and_suggest), cmocka_unit_test(test_longer_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
