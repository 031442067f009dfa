/* test_bloom.c: bloom=glare keeps a constant and the sum of light, and makes of a point the
 * point-spread function. */
#include "support/display_picture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>
#include <psplat/math.h>

enum { WIDTH = 201, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

struct planes {
    float rgb[3][PIXELS];
};

static ps_display_view view_of(struct planes *planes)
{
    return (ps_display_view){sizeof(ps_display_view), WIDTH,          HEIGHT,        0,
                             planes->rgb[0],          planes->rgb[1], planes->rgb[2]};
}

static double sum_of(const float *plane)
{
    double sum = 0.0;
    for (int i = 0; i < PIXELS; i++)
        sum += (double)plane[i];
    return sum;
}

static void bloom(const char *choice, struct planes *planes)
{
    const ps_display_view view = view_of(planes);
    run_display(choice, 2, &view, PS_OK);
}

static struct planes *level(float value)
{
    struct planes *planes = calloc(1, sizeof *planes);
    assert_non_null(planes);
    for (int i = 0; i < PIXELS; i++)
        planes->rgb[0][i] = planes->rgb[1][i] = planes->rgb[2][i] = value;
    return planes;
}

/* Also where the widest Gaussian is wider than the picture. */
static void test_a_constant_stays(void **state)
{
    (void)state;
    static const char *const choices[] = {"bloom=glare:strength=1", "bloom=glare:radius=0.001",
                                          "bloom=glare:strength=1,radius=1"};
    for (int k = 0; k < 3; k++) {
        struct planes *planes = level(3.0f);
        bloom(choices[k], planes);
        for (int i = 0; i < PIXELS; i++)
            assert_float_equal(planes->rgb[k][i], 3.0f, 2e-5f);
        free(planes);
    }
}

/* The whole light stays in the picture, that of corners too. */
static void test_light_is_kept(void **state)
{
    (void)state;
    static const int places[] = {0, PIXELS - 1, 80 * WIDTH + 100, 40 * WIDTH};
    for (int k = 0; k < 4; k++) {
        struct planes *planes = level(0.0f);
        planes->rgb[0][places[k]] = 1000.0f;
        bloom("bloom=glare:strength=0.7,radius=0.3", planes);
        assert_float_equal(sum_of(planes->rgb[0]), 1000.0, 0.05);
        assert_true(planes->rgb[0][places[k]] < 400.0f);
        assert_float_equal(sum_of(planes->rgb[1]), 0.0, 0.0);
        free(planes);
    }
}

/* Of the octaves, at a distance of x and y pixels. */
static double gaussians(double radius, double x, double y)
{
    double sum = 0.0;
    for (int octave = 0; octave < 4; octave++) {
        double variance = pow(radius * HEIGHT / (1 << octave), 2.0);
        sum += exp(-(x * x + y * y) / (2.0 * variance)) / (2.0 * PS_PI * variance) / 4.0;
    }
    return sum;
}

/* Along the row, the column and the diagonal of the point: round, and as near to the Gaussians as
 * three boxes are: within a tenth of the peak at the peak, and within 3 % of it elsewhere. */
static void test_a_point_becomes_the_psf(void **state)
{
    (void)state;
    const double radius = 0.1, strength = 0.5, peak = gaussians(radius, 0, 0);
    const int x = WIDTH / 2, y = HEIGHT / 2;
    struct planes *planes = level(0.0f);
    planes->rgb[1][y * WIDTH + x] = 1.0f;
    bloom("bloom=glare:strength=0.5,radius=0.1", planes);
    const float *plane = planes->rgb[1];
    for (int d = 0; d < 50; d++) {
        double tolerance = (d < 3 ? 0.1 : 0.03) * strength * peak;
        double core = d == 0 ? 1.0 - strength : 0.0;
        double along = strength * gaussians(radius, d, 0) + core;
        double across = strength * gaussians(radius, d, d) + core;
        assert_float_equal(plane[y * WIDTH + x + d], along, tolerance);
        assert_float_equal(plane[(y - d) * WIDTH + x], along, tolerance);
        assert_float_equal(plane[(y + d) * WIDTH + x - d], across, tolerance);
    }
    free(planes);
}

static void test_threshold(void **state)
{
    (void)state;
    struct planes *planes = level(0.5f);
    struct planes *before = level(0.5f);
    bloom("bloom=glare:strength=1,threshold=0.6", planes);
    assert_memory_equal(planes, before, sizeof *planes);
    /* Of a luminance of 3, the part above 1 is spread. */
    planes->rgb[0][0] = planes->rgb[1][0] = planes->rgb[2][0] = 3.0f;
    bloom("bloom=glare:strength=1,threshold=1,radius=0.2", planes);
    assert_true(planes->rgb[0][0] > 1.0f && planes->rgb[0][0] < 1.2f);
    assert_float_equal(sum_of(planes->rgb[0]), 0.5 * (PIXELS - 1) + 3.0, 0.05);
    free(before);
    free(planes);
}

static void test_threads_and_cancelling(void **state)
{
    (void)state;
    struct planes *one = level(1.0f), *many = level(1.0f);
    one->rgb[2][777] = many->rgb[2][777] = 1e6f;
    const ps_display_view first = view_of(one), second = view_of(many);
    run_display("bloom=glare", 1, &first, PS_OK);
    run_display("bloom=glare", 4, &second, PS_OK);
    assert_memory_equal(one, many, sizeof *one);
    run_display("bloom=glare", 2, &first, PS_CANCELLED);
    free(one);
    free(many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_constant_stays),        cmocka_unit_test(test_light_is_kept),
        cmocka_unit_test(test_a_point_becomes_the_psf), cmocka_unit_test(test_threshold),
        cmocka_unit_test(test_threads_and_cancelling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
