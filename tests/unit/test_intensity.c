/* test_intensity.c: the normalization `intensity` on a film made by hand, against its formula and
 * against the other two normalizations. */
#include "support/one_strategy.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#define PIXELS 5
#define PASSES 4

/* Pixel 1 has the largest weight in a covered pass, 5, but pixel 0 the largest sum; pixel 3 learned
 * nothing, and pixel 4 saw nothing. */
static const float red[PIXELS] = {6, 2, 3, 0, 0}, green[PIXELS] = {3, 1, 9, 0, 0};
static const float blue[PIXELS] = {1, 7, 2, 0, 0}, weight[PIXELS] = {12, 10, 4, 0, 0};
static const float coverage[PIXELS] = {4, 2, 4, 4, 0};

struct picture {
    float r[PIXELS], g[PIXELS], b[PIXELS];
};

static struct picture resolve(const char *normalization)
{
    const ps_film_view film = {
        .size = sizeof film,
        .passes = PASSES,
        .pixel_count = PIXELS,
        .color_r = red,
        .color_g = green,
        .color_b = blue,
        .weight = weight,
        .coverage = coverage,
    };
    struct bare_host bare;
    struct picture picture;
    bare_host_create(&bare, 1);
    struct strategy strategy = strategy_of(normalization);
    const ps_normalization_vtable *vtable = &strategy.type->table.normalization;
    assert_int_equal(
        vtable->resolve(strategy.state, &bare.host, &film, picture.r, picture.g, picture.b), PS_OK);
    strategy_release(&strategy);
    bare_host_release(&bare);
    return picture;
}

static void expect_near(float value, double expected)
{
    assert_true(fabs(value - expected) <= 1e-6 * fabs(expected));
}

static void test_quotient_times_relative_weight(void **state)
{
    (void)state;
    struct picture quotient = resolve("normalization=weight:exposure=3");
    struct picture intensity = resolve("normalization=intensity:exposure=3");
    const double maximum = 5;
    for (int i = 0; i < 3; i++) {
        double relative = weight[i] / coverage[i] / maximum;
        expect_near(intensity.r[i], quotient.r[i] * relative);
        expect_near(intensity.g[i], quotient.g[i] * relative);
        expect_near(intensity.b[i], quotient.b[i] * relative);
    }
    expect_near(intensity.r[0], 3 * 6 / (maximum * PASSES));
}

static void test_automatic_exposure_is_density(void **state)
{
    (void)state;
    struct picture density = resolve("normalization=density");
    struct picture intensity = resolve("normalization=intensity");
    for (int i = 0; i < PIXELS; i++) {
        expect_near(intensity.r[i], density.r[i]);
        expect_near(intensity.g[i], density.g[i]);
        expect_near(intensity.b[i], density.b[i]);
    }
}

static void test_pixels_without_weight_are_dark(void **state)
{
    (void)state;
    struct picture intensity = resolve("normalization=intensity:exposure=2");
    for (int i = 3; i < PIXELS; i++)
        assert_true(intensity.r[i] == 0 && intensity.g[i] == 0 && intensity.b[i] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quotient_times_relative_weight),
        cmocka_unit_test(test_automatic_exposure_is_density),
        cmocka_unit_test(test_pixels_without_weight_are_dark),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
