/* test_exposure.c: the exposure that brings the log-average luminance of a picture to 0.18. */
#include "image/exposure.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

enum { PIXELS = 1000 };

static double stops_of(const float *luminance)
{
    const float *const light[3] = {luminance, luminance, luminance};
    return exposure_automatic(light, PIXELS);
}

static void fill(float *luminance, int first, int last, float value)
{
    for (int i = first; i < last; i++)
        luminance[i] = value;
}

static void test_known_pictures(void **state)
{
    (void)state;
    float luminance[PIXELS];
    fill(luminance, 0, PIXELS, 0.18f);
    assert_float_equal(stops_of(luminance), 0.0, 0.012);
    fill(luminance, 0, PIXELS, 4 * 0.18f);
    assert_float_equal(stops_of(luminance), -2.0, 0.012);
    fill(luminance, 0, PIXELS / 2, 0.18f / 4); /* the geometric mean */
    assert_float_equal(stops_of(luminance), 0.0, 0.012);
    fill(luminance, 0, PIXELS, 0.0f);
    assert_float_equal(stops_of(luminance), 0.0, 0.0);
}

/* What is black, infinite, no number, or among the extreme hundredths has no say. */
static void test_outliers(void **state)
{
    (void)state;
    float luminance[PIXELS];
    fill(luminance, 0, PIXELS, 0.36f);
    fill(luminance, 0, 300, 0.0f);
    fill(luminance, 300, 302, NAN);
    fill(luminance, 302, 304, INFINITY);
    fill(luminance, 304, 306, -1.0f);
    fill(luminance, 306, 312, 1e30f);
    fill(luminance, 312, 318, 1e-30f);
    assert_float_equal(stops_of(luminance), -1.0, 0.012);
    fill(luminance, 306, 420, 1e3f); /* a sixth of the picture has */
    assert_true(stops_of(luminance) < -1.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_pictures),
        cmocka_unit_test(test_outliers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
