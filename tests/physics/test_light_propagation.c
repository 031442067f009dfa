/* test_light_propagation.c: the estimator `lpv` on open planes: a floor that a spotlight lights,
 * and a plate above it.
 *
 * A spotlight of intensity I and half angle a at height l lights the floor with I l / (r^2 +
 * l^2)^(3/2); of albedo k, this gives the point of the plate above it, at height h,
 *
 *     E = integral over r of 2 k h^2 / (r^2 + h^2)^2 * I l / (r^2 + l^2)^(3/2) r dr
 *
 * for r < l tan(a).
 *
 * Cells pass light on into all directions that order 1 knows, so light goes astray on its way, the
 * more, the more cells are in between: two cells away a quarter is missing, six cells away two
 * thirds.
 */
#include "support/statistics_of.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

static double irradiance(double height, double lamp)
{
    enum { STEPS = 20000 };
    double most = lamp * sqrt(3), sum = 0;
    for (int i = 0; i < STEPS; i++) {
        double r = most * (i + 0.5) / STEPS, d2 = r * r + height * height;
        sum += 2 * 0.8 * height * height / (d2 * d2) * 100 * lamp * pow(r * r + lamp * lamp, -1.5) *
               r * most / STEPS;
    }
    return sum;
}

static double found(double height, double lamp, const char *estimator)
{
    char scene[2048];
    const char *const choices[] = {estimator, "bounces=1", "injection=photon:count=20000", NULL};
    snprintf(scene, sizeof scene,
             "psd: 1\n"
             "camera: {location: [%g, %g, 0], look_at: [0, %g, 0], angle: 1}\n"
             "image: {width: 16, height: 16}\n"
             "materials: {floor: {diffuse: 0.8}, plate: {diffuse: 0.5}}\n"
             "lights: [{spotlight: {location: [0, %g, 0], point_at: [0, 0, 0], radius: 60,\n"
             "                      falloff: 60, intensity: 100}}]\n"
             "objects:\n"
             "  - quad: {corners: [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]],\n"
             "           material: floor}\n"
             "  - quad: {corners: [[-1, %g, -1], [1, %g, -1], [1, %g, 1], [-1, %g, 1]],\n"
             "           material: plate}\n"
             "render: {seed: %%d}\n",
             0.4 * height, 0.2 * height, height, lamp, height, height, height, height);
    return estimate_channel(scene, choices, "indirect.G", 12).mean * PI / 0.5;
}

static void check(double height, const char *estimator, double least, double most)
{
    double ratio = found(height, 0.9 * height, estimator) / irradiance(height, 0.9 * height);
    print_message("plate at %g, %s: %.3f of the closed form\n", height, estimator, ratio);
    assert_true(ratio > least && ratio < most);
}

/* The scene is about 3 wide, so 16 cells have sides of 0.19. */
static void test_plates(void **state)
{
    (void)state;
    check(0.4, "estimator=lpv:cascades=1", 0.65, 0.9);
    check(1.2, "estimator=lpv:cascades=1", 0.3, 0.5);
}

/* More steps than there are by themselves add little; without any, no light has left the floor. */
static void test_steps(void **state)
{
    (void)state;
    double automatic = found(0.8, 0.72, "estimator=lpv:cascades=1");
    double many = found(0.8, 0.72, "estimator=lpv:cascades=1,steps=2000");
    double none = found(0.8, 0.72, "estimator=lpv:cascades=1,steps=0");
    print_message("automatic steps: %.4f of 2000, none: %.4f\n", automatic / many, none / many);
    assert_true(automatic <= many * 1.0001 && automatic > 0.95 * many);
    assert_true(none == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plates),
        cmocka_unit_test(test_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
