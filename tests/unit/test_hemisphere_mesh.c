/* test_hemisphere_mesh.c: derivatives of irradiance from rays over a hemisphere are those of
 * Lambert's formula for a rectangle that shines, and for one that stands before a bright plane. */
#include "../plugins/estimator/irradiance_cache/hemisphere_mesh.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

enum { RINGS = 64, SECTORS = 200 };

/* Parallel to the ground. */
struct rectangle {
    double x[2], y[2], height;
};

/* Of one edge, theta n.(a x b) / |a x b|. */
static double edge_share(const double a[3], const double b[3])
{
    double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double length = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    return atan2(length, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * c[2] / length;
}

/* Irradiance at a point of the ground by a rectangle of radiance 1 (Lambert 1760). */
static double irradiance(const struct rectangle *rectangle, double x, double y)
{
    double corners[4][3], sum = 0;
    for (int i = 0; i < 4; i++) {
        corners[i][0] = rectangle->x[i == 1 || i == 2] - x;
        corners[i][1] = rectangle->y[i >= 2] - y;
        corners[i][2] = rectangle->height;
    }
    for (int i = 0; i < 4; i++)
        sum += edge_share(corners[i], corners[(i + 1) % 4]);
    return 0.5 * sum;
}

struct expected {
    double x, y, xx, xy, yy;
};

static struct expected differentiate(const struct rectangle *of)
{
    const double h = 1e-3;
    double middle = irradiance(of, 0, 0);
    double left = irradiance(of, -h, 0), right = irradiance(of, h, 0);
    double down = irradiance(of, 0, -h), up = irradiance(of, 0, h);
    return (struct expected){
        .x = (right - left) / (2 * h),
        .y = (up - down) / (2 * h),
        .xx = (right - 2 * middle + left) / (h * h),
        .xy = (irradiance(of, h, h) - irradiance(of, h, -h) - irradiance(of, -h, h) +
               irradiance(of, -h, -h)) /
              (4 * h * h),
        .yy = (up - 2 * middle + down) / (h * h),
    };
}

/* The rectangle has radiance `inside`, and a plane at height 2 behind it `outside`. */
static struct hemisphere_derivatives look(const struct rectangle *rectangle, float inside,
                                          float outside)
{
    static ps_vec3 hits[RINGS * SECTORS];
    static ps_rgb radiance[RINGS * SECTORS];
    for (int i = 0; i < RINGS * SECTORS; i++) {
        int ring = i / SECTORS;
        double square = (ring + 0.5) / RINGS, angle = 2 * PI * (i % SECTORS + 0.5) / SECTORS;
        double slope = sqrt(square / (1 - square));
        double x = slope * cos(angle), y = slope * sin(angle), height = rectangle->height;
        int in = x * height > rectangle->x[0] && x * height < rectangle->x[1] &&
                 y * height > rectangle->y[0] && y * height < rectangle->y[1];
        float distance = in ? (float)height : 2, found = in ? inside : outside;
        hits[i] = (ps_vec3){(float)x * distance, (float)y * distance, distance};
        radiance[i] = (ps_rgb){found, 2 * found, 3 * found};
    }
    const struct hemisphere hemisphere = {RINGS, SECTORS, hits, radiance};
    return hemisphere_derivatives(&hemisphere);
}

/* The mesh follows the rectangle's sides in steps. */
static void expect_near(const char *what, double found, double expected, double allowed)
{
    print_message("%-3s %8.4f, expected %8.4f, within %.4f\n", what, found, expected, allowed);
    assert_true(fabs(found - expected) < allowed);
}

/* `factor`: of a rectangle of radiance 1. */
static void expect_derivatives(const struct rectangle *rectangle, float inside, float outside,
                               double factor)
{
    struct hemisphere_derivatives found = look(rectangle, inside, outside);
    struct expected expected = differentiate(rectangle);
    double luminance = factor * (0.2126 + 2 * 0.7152 + 3 * 0.0722);
    double first = 0.05 * fabs(factor) * hypot(expected.x, expected.y);
    double second = 0.1 * fabs(luminance) * hypot(expected.xx, expected.yy);
    expect_near("x", found.gradient_x.r, factor * expected.x, first);
    expect_near("y", found.gradient_y.r, factor * expected.y, first);
    expect_near("x", found.gradient_x.b / 3, factor * expected.x, first);
    expect_near("y", found.gradient_y.g / 2, factor * expected.y, first);
    expect_near("xx", found.xx, luminance * expected.xx, second);
    expect_near("xy", found.xy, luminance * expected.xy, second);
    expect_near("yy", found.yy, luminance * expected.yy, second);
}

static void test_source(void **state)
{
    (void)state;
    const struct rectangle aside = {{0.3, 2}, {-0.5, 1.2}, 2}, above = {{-0.9, 1.1}, {-1, 1}, 2};
    expect_derivatives(&aside, 1, 0, 1);
    expect_derivatives(&above, 5, 0, 5);
    expect_derivatives(&aside, 1, 4, -3);
}

/* Where the near rectangle ends, more of the plane shows as the point moves. */
static void test_occluder(void **state)
{
    (void)state;
    const struct rectangle near = {{0.1, 0.8}, {-0.4, 0.3}, 0.5};
    expect_derivatives(&near, 0, 1, -1);
    expect_derivatives(&near, 0.25f, 1, -0.75);
}

static void test_even_light(void **state)
{
    (void)state;
    const struct rectangle near = {{0.1, 0.8}, {-0.4, 0.3}, 0.5};
    struct hemisphere_derivatives found = look(&near, 3, 3);
    assert_true(fabsf(found.gradient_x.r) + fabsf(found.gradient_y.r) < 1e-5f);
    assert_true(fabsf(found.xx) + fabsf(found.xy) + fabsf(found.yy) < 1e-5f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_source),
        cmocka_unit_test(test_occluder),
        cmocka_unit_test(test_even_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
