/* test_furnace.c: a closed form: a lamp in the middle of a diffuse sphere.
 *
 * A point light of intensity I at the centre of a sphere of radius r and albedo a gives every point
 * the same irradiance E0 = I / r^2. A diffuse sphere spreads what it reflects evenly over itself,
 * so one bounce gives a E0 everywhere, and all bounces a E0 / (1 - a); the radiance is a / pi times
 * that.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

/* Of the lamp, by W/sr; chosen so that E0 is 1. */
#define SCENE                                                                                      \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 0, 0], look_at: [1, 0.3, 0.2], angle: 90}\n"                           \
    "image: {width: 48, height: 48}\n"                                                             \
    "materials: {wall: {diffuse: %s}}\n"                                                           \
    "lights: [{point: {location: [0, 0, 0], intensity: 4}}]\n"                                     \
    "objects: [{sphere: {center: [0, 0, 0], radius: 2, material: wall}}]\n"                        \
    "render: {visibility: {shadowmap: {size: %s, step_back: %s}}}\n"

static void expect_mean_with(const char *albedo, const char *injection, const char *size,
                             const char *step_back, double irradiance)
{
    char text[1024];
    const char *const choices[] = {injection, NULL};
    snprintf(text, sizeof text, SCENE, albedo, size, step_back);
    struct rendering rendering = render_text(text, 2, choices);
    double a = strtod(albedo, NULL);
    double expected = a / PI * irradiance;
    double direct = mean_of_all(&rendering.image, "direct.G");
    double indirect = mean_of_all(&rendering.image, "indirect.G");
    print_message("albedo %s, %s, step_back %s: direct / expected %.5f, indirect / expected %.4f\n",
                  albedo, injection, step_back, direct / (a / PI), indirect / expected);
    assert_true(fabs(direct / (a / PI) - 1) < 1e-3);
    assert_true(fabs(indirect / expected - 1) < 0.02);
    rendering_release(&rendering);
}

static void expect_mean(const char *albedo, const char *injection, double irradiance)
{
    expect_mean_with(albedo, injection, "0.05", "auto", irradiance);
}

static void test_one_bounce(void **state)
{
    (void)state;
    expect_mean("0.5", "injection=photon:count=300000,bounces=1", 0.5);
    expect_mean_with("0.5", "injection=photon:count=300000,bounces=1", "0.03", "full", 0.5);
}

static void test_two_bounces(void **state)
{
    (void)state;
    expect_mean("0.5", "injection=photon:count=200000,bounces=2", 0.5 + 0.25);
}

static void test_all_bounces(void **state)
{
    (void)state;
    expect_mean("0.5", "injection=photon:count=200000,bounces=0", 0.5 / (1 - 0.5));
    expect_mean("0.8", "injection=photon:count=100000,bounces=0", 0.8 / (1 - 0.8));
}

static void test_russian_roulette_keeps_the_mean(void **state)
{
    (void)state;
    expect_mean("0.6", "injection=photon:count=200000,bounces=3,roulette=0", 0.6 + 0.36 + 0.216);
    expect_mean("0.6", "injection=photon:count=200000,bounces=3,roulette=1", 0.6 + 0.36 + 0.216);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_bounce),
        cmocka_unit_test(test_two_bounces),
        cmocka_unit_test(test_all_bounces),
        cmocka_unit_test(test_russian_roulette_keeps_the_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
