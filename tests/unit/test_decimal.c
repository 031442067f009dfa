/* Decimal numbers within texts, beside strtod. */
#include "base/decimal.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double read_all(const char *text)
{
    const char *at = text;
    double value = NAN;
    assert_true(decimal_read(&at, text + strlen(text), &value));
    if (*at != '\0')
        fail_msg("\"%s\" is left of \"%s\"", at, text);
    return value;
}

static void short_numbers_are_exact(void **state)
{
    static const char *const texts[] = {
        "0",     "-0",     "1",      "+2",       ".5",     "5.",
        "-1.25", "1e3",    "1E-3",   "-2.5e+2",  "0.1",    "000.007",
        "1e22",  "3e-22",  "123456", "0.333333", "-17.73", "9007199254740992",
        "1e-5",  "6.02e23"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        assert_true(read_all(texts[i]) == strtod(texts[i], NULL));
    assert_true(signbit(read_all("-0")));
}

static void floats_come_back(void **state)
{
    uint32_t bits = 1;
    (void)state;
    for (int i = 0; i < 200000; i++) {
        char text[64];
        float value;
        bits = bits * 1664525u + 1013904223u;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        snprintf(text, sizeof text, i % 2 ? "%.9g" : "%.17g", (double)value);
        if ((float)read_all(text) != value)
            fail_msg("%s became %.9g", text, read_all(text));
    }
}

static void far_out_of_range(void **state)
{
    char text[5000];
    (void)state;
    assert_true(isinf(read_all("1e400")) && isinf(read_all("-1e999999999999")));
    assert_true(read_all("1e-400") == 0.0 && read_all("0e999999999") == 0.0);
    assert_true(fabs(read_all("1.7e308") / 1.7e308 - 1) < 1e-14);
    memset(text, '0', sizeof text);
    text[1] = '.';
    strcpy(text + 4000, "25e3998"); /* 3998 zeros behind the point */
    assert_true(fabs(read_all(text) - 0.25) < 1e-12);
    memset(text, '7', sizeof text);
    strcpy(text + 4000, "e-3999");
    assert_true(fabs(read_all(text) - 7.77777777777) < 1e-10);
}

static void only_the_number_is_taken(void **state)
{
    static const char *const none[] = {"", "-", "+", ".", "-.", "e5", "x", "nan", " 1", "--1"};
    const char text[] = "1.5/2 3e x12", *at = text, *end = text + sizeof text - 1;
    double value;
    (void)state;
    assert_true(decimal_read(&at, end, &value) && value == 1.5 && *at == '/');
    at = text + 6;
    assert_true(decimal_read(&at, end, &value) && value == 3 && *at == 'e');
    at = text;
    assert_true(decimal_read(&at, text + 2, &value) && value == 1 && at == text + 2);
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        at = none[i];
        assert_false(decimal_read(&at, at + strlen(at), &value));
        assert_ptr_equal(at, none[i]);
    }
}

static void whole_numbers(void **state)
{
    const char *texts[] = {"12/3", "-7", "+4", "123456789012345678", "1234567890123456789",
                           "-",    "a"};
    const long long values[] = {12, -7, 4, 123456789012345678};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        const char *at = texts[i];
        long long value = 0;
        assert_int_equal(decimal_read_integer(&at, at + strlen(at), &value), i < 4);
        if (i < 4)
            assert_true(value == values[i]);
        else
            assert_ptr_equal(at, texts[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_numbers_are_exact), cmocka_unit_test(floats_come_back),
        cmocka_unit_test(far_out_of_range),        cmocka_unit_test(only_the_number_is_taken),
        cmocka_unit_test(whole_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
