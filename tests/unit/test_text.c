/* test_text.c: numbers as text, in any locale; distances between words. */
#include "base/text.h"

#include "support/random.h"
#include "unit/locale_fixture.h"
#include <float.h>

static void expect_number(const char *text, double expected)
{
    double value = 12345;
    if (!text_to_number(text, &value))
        fail_msg("'%s' was refused", text);
    if (memcmp(&value, &expected, sizeof value) != 0)
        fail_msg("'%s' became %.17g", text, value);
}

static void expect_refused(const char *text)
{
    double value;
    if (text_to_number(text, &value))
        fail_msg("'%s' became %.17g", text, value);
}

static void read_numbers(void)
{
    expect_number("0", 0);
    expect_number("-0", -0.0);
    expect_number("42", 42);
    expect_number("+2", 2);
    expect_number("-1.5e3", -1500);
    expect_number(".5", 0.5);
    expect_number("5.", 5);
    expect_number("1e3", 1000);
    expect_number("1E+3", 1000);
    expect_number("25e-2", 0.25);
    expect_number("007", 7);
    expect_number("0.1", 0.1);
    expect_number("3.141592653589793", 3.141592653589793);
    expect_number("1.7976931348623157e308", DBL_MAX);
    expect_number("1e-400", 0);
}

static void test_reads_numbers(void **state)
{
    (void)state;
    read_numbers();
}

static void test_reads_parts(void **state)
{
    (void)state;
    char digits[80];
    double value;
    assert_true(text_part_to_number("12.5s", 4, &value) && value == 12.5);
    assert_true(text_part_to_number("640x360", 3, &value) && value == 640);
    assert_false(text_part_to_number("12.5s", 5, &value));
    assert_false(text_part_to_number("12", 0, &value));
    memset(digits, '1', sizeof digits);
    assert_true(text_part_to_number(digits, 63, &value) && value > 1e62);
    assert_false(text_part_to_number(digits, 64, &value)); /* not the first of its digits */
}

static void refuse_others(void)
{
    static const char *const texts[] = {
        "",
        " ",
        "+",
        "-",
        ".",
        "-.",
        "e5",
        ".e5",
        "1e",
        "1e+",
        "0x10",
        "0X1p3",
        "inf",
        "-inf",
        "INFINITY",
        "nan",
        "NaN",
        "nan(1)",
        "1 ",
        " 1",
        "1,5",
        "1.5.2",
        "1e2.5",
        "1.5x",
        "--1",
        "+-1",
        "1_000",
        "1'000",
        "1e309",
        "-1e400",
        "1\n",
        "\t1",
        "1f",
        "1e5e5",
        "\xef\xbc\x91",
        "1e99999999999",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        expect_refused(texts[i]);
}

static void test_refuses_what_is_no_number(void **state)
{
    (void)state;
    refuse_others();
}

static void test_long_texts(void **state)
{
    (void)state;
    char text[200];
    memset(text, '1', sizeof text);
    text[1] = '.';
    text[30] = '\0';
    expect_number(text, 1.1111111111111111);
    text[30] = '1';
    text[199] = '\0';
    expect_refused(text); /* longer than any number need be: refused, not cut */
}

static double any_number(struct random *random)
{
    double value;
    do {
        uint64_t bits = random_bits(random);
        memcpy(&value, &bits, sizeof value);
    } while (!isfinite(value));
    return value;
}

static void expect_round_trip(double value)
{
    char text[64];
    text_from_number(value, text, sizeof text);
    expect_number(text, value);
    assert_null(strchr(text, ','));
}

static void expect_float_round_trip(float value)
{
    char text[64];
    double back;
    text_from_float(value, text, sizeof text);
    assert_true(text_to_number(text, &back));
    assert_true((float)back == value);
}

static void write_and_read(void)
{
    static const double values[] = {0,   -0.0,     1,       -1,          0.1,     1.0 / 3, 1e21,
                                    1e5, 123456.5, DBL_MAX, DBL_EPSILON, DBL_MIN, 1e-7,    4e-320};
    struct random random = {3};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++)
        expect_round_trip(values[i]);
    for (int i = 0; i < 20000; i++) {
        expect_round_trip(any_number(&random));
        expect_round_trip(random_between(&random, -1000, 1000));
        float single = (float)random_between(&random, -1, 1) * powf(10, (float)(i % 60) - 30);
        expect_float_round_trip(single);
    }
}

static void test_round_trip(void **state)
{
    (void)state;
    write_and_read();
}

static void expect_text(double value, const char *expected)
{
    char text[64];
    text_from_number(value, text, sizeof text);
    assert_string_equal(text, expected);
}

static void write_known(void)
{
    expect_text(0.1, "0.1");
    expect_text(0.25, "0.25");
    expect_text(3, "3");
    expect_text(-2.5, "-2.5");
    expect_text(100000, "100000");
    expect_text(2000000000, "2e+09");
    expect_text(1.0 / 3, "0.3333333333333333");
    char text[64];
    text_from_float(0.1f, text, sizeof text);
    assert_string_equal(text, "0.1");
    text_from_float(1.0f / 3, text, sizeof text);
    assert_string_equal(text, "0.33333334");
}

static void test_shortest_text(void **state)
{
    (void)state;
    write_known();
}

static void do_all_in(void **state, const char *name, const char *point)
{
    if (!use_locale(state, name, point)) {
        print_message("skipped: no locale %s here\n", name);
        return;
    }
    read_numbers();
    refuse_others();
    write_and_read();
    write_known();
}

static void test_comma_locale(void **state)
{
    do_all_in(state, "de_DE.UTF-8", ",");
}

/* A decimal point of more than one byte. */
static void test_wide_point_locale(void **state)
{
    do_all_in(state, "ps_AF.UTF-8", "\xd9\xab");
}

static void expect_distance(const char *a, const char *b, size_t expected)
{
    assert_int_equal(text_distance(a, b), expected);
    assert_int_equal(text_distance(b, a), expected);
}

static void test_distances(void **state)
{
    (void)state;
    expect_distance("", "", 0);
    expect_distance("radius", "radius", 0);
    expect_distance("", "abc", 3);
    expect_distance("radios", "radius", 1); /* another letter */
    expect_distance("radus", "radius", 1);  /* one missing */
    expect_distance("raduis", "radius", 1); /* two swapped */
    expect_distance("ab", "ba", 1);
    expect_distance("ca", "abc", 3); /* no edits inside of a swap */
    expect_distance("kitten", "sitting", 3);
    expect_distance("abcdef", "badcfe", 3);
    expect_distance("abc", "xyz", 3);
}

static void test_long_words_are_far(void **state)
{
    (void)state;
    char word[101], edge[65];
    memset(word, 'a', 100);
    memset(edge, 'a', 64);
    word[100] = edge[64] = '\0';
    expect_distance(edge, "", 64);
    expect_distance(word, "", SIZE_MAX);
    assert_false(text_is_near(word, "radius"));
}

static void test_near_words(void **state)
{
    (void)state;
    assert_true(text_is_near("radios", "radius"));
    assert_true(text_is_near("colour", "color"));
    assert_true(text_is_near("resolutoin", "resolution"));
    assert_true(text_is_near("stratifcaton", "stratification"));
    assert_false(text_is_near("bias", "size"));
    assert_false(text_is_near("depth", "follow"));
    assert_false(text_is_near("xyz", "box"));
}

static void expect_size(double bytes, const char *expected)
{
    char text[TEXT_SIZE_LENGTH];
    assert_string_equal(text_of_size(bytes, text), expected);
}

static void test_sizes(void **state)
{
    (void)state;
    expect_size(0, "0 MiB");
    expect_size(1, "1 MiB");
    expect_size(0x1p20, "1 MiB");
    expect_size(640.2 * 0x1p20, "641 MiB");
    expect_size(0x1p30, "1.0 GiB");
    expect_size(5.26 * 0x1p30, "5.3 GiB");
    expect_size(INFINITY, "inf GiB");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reads_parts),
        cmocka_unit_test(test_reads_numbers),
        cmocka_unit_test(test_refuses_what_is_no_number),
        cmocka_unit_test(test_long_texts),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_shortest_text),
        LOCALE_TEST(test_comma_locale),
        LOCALE_TEST(test_wide_point_locale),
        cmocka_unit_test(test_distances),
        cmocka_unit_test(test_long_words_are_far),
        cmocka_unit_test(test_near_words),
        cmocka_unit_test(test_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
