/* test_metric_limits.c: metrics by name, bounds on them, and the heat map's colours. */
#include "compare/heatmap.h"
#include "compare/metric.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

static void test_limits(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double numbers[2];
        bool refused;
    } cases[] = {
        {"bias>1.01", {1.0, 1.01}, false}, {"bias>1.01", {1.0, 1.02}, true},
        {"bias>=1.01", {1.0, 1.01}, true}, {"bias<0.99", {0.98, 1.0}, true},
        {"bias<1", {1.0, 1.0}, false},     {"bias<=1", {1.0, 1.5}, true},
        {"psnr>1e9", {NAN, 1.0}, true},    {"psnr<40", {INFINITY, INFINITY}, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct metric_limit limit;
        struct metric_value value = {2, {cases[i].numbers[0], cases[i].numbers[1]}};
        struct error error;
        assert_int_equal(metric_limit_parse(cases[i].text, &limit, &error), PS_OK);
        assert_int_equal(metric_limit_refuses(&limit, &value), cases[i].refused);
    }
}

static void test_malformed_limits(void **state)
{
    (void)state;
    static const char *const texts[] = {"",         "bias",    ">1",      "bias>",
                                        "bias>x",   "bias=1",  "bias>>1", "bais>1",
                                        "bias>nan", "bias>1 ", "bias >1"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct metric_limit limit;
        struct error error;
        assert_int_equal(metric_limit_parse(texts[i], &limit, &error), PS_ERROR_INVALID);
    }
}

static void test_names(void **state)
{
    (void)state;
    struct error error;
    enum metric metric;
    for (enum metric i = 0; i < METRIC_COUNT; i++) {
        assert_int_equal(metric_find(metric_name(i), strlen(metric_name(i)), &metric, &error),
                         PS_OK);
        assert_int_equal(metric, i);
    }
    assert_int_equal(metric_find("thesis_rsme", 11, &metric, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "did you mean 'thesis_rmse'?"));
}

static void test_heatmap_colours(void **state)
{
    (void)state;
    uint8_t rgb[3];
    double last = -1.0;
    for (int i = 0; i <= 100; i++) {
        heatmap_colour(i / 100.0, rgb);
        double lightness = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        assert_true(lightness > last);
        last = lightness;
    }
    heatmap_colour(-INFINITY, rgb);
    assert_memory_equal(rgb, ((const uint8_t[]){0, 0, 4}), 3);
    heatmap_colour(7.0, rgb);
    assert_memory_equal(rgb, ((const uint8_t[]){252, 253, 191}), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_malformed_limits),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_heatmap_colours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
