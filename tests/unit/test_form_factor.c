/* test_form_factor.c: form factors of triangles against closed forms, and directions that are even
 * over a triangle. */
#include "../plugins/estimator/radiosity/form_factor.h"
#include "../plugins/estimator/radiosity/spherical_triangle.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

static void expect_near(const char *what, double found, double expected, double allowed)
{
    print_message("%-24s %.6f, expected %.6f\n", what, found, expected);
    assert_true(fabs(found - expected) < allowed);
}

/* Of a rectangle, whose corners run counter-clockwise. */
static double of_rectangle(ps_vec3 x, ps_vec3 n, const ps_vec3 c[4])
{
    const ps_vec3 halves[2][3] = {{c[0], c[1], c[2]}, {c[0], c[2], c[3]}};
    return (double)form_factor_triangle(x, n, halves[0]) +
           (double)form_factor_triangle(x, n, halves[1]);
}

/* A parallel rectangle of sides a and b with a corner at height c above the point (Howell, B-4). */
static void test_parallel_rectangle(void **state)
{
    (void)state;
    const ps_vec3 corners[4] = {{0, 0, 2}, {0, 3, 2}, {1, 3, 2}, {1, 0, 2}};
    double x = 1.0 / 2, y = 3.0 / 2;
    double expected = (x / sqrt(1 + x * x) * atan(y / sqrt(1 + x * x)) +
                       y / sqrt(1 + y * y) * atan(x / sqrt(1 + y * y))) /
                      (2 * PI);
    ps_vec3 origin = {0, 0, 0}, up = {0, 0, 1}, down = {0, 0, -1};
    expect_near("parallel", of_rectangle(origin, up, corners), expected, 1e-5);
    expect_near("behind the receiver", of_rectangle(origin, down, corners), 0, 1e-7);
    expect_near("from the back", of_rectangle((ps_vec3){0, 0, 4}, down, corners), 0, 1e-7);
}

/* A wall that begins at the point's own plane, and half of which lies below it. */
static void test_wall_through_the_horizon(void **state)
{
    (void)state;
    const double a = 1, b = 2, c = 0.5; /* width to one side, height, distance */
    const ps_vec3 whole[4] = {{0, 0.5f, -2}, {1, 0.5f, -2}, {1, 0.5f, 2}, {0, 0.5f, 2}};
    double slant = sqrt(b * b + c * c);
    double expected = (atan(a / c) - c / slant * atan(a / slant)) / (2 * PI);
    expect_near("wall", of_rectangle((ps_vec3){0, 0, 0}, (ps_vec3){0, 0, 1}, whole), expected,
                1e-5);
}

static void test_small_surface(void **state)
{
    (void)state;
    const ps_vec3 corners[3] = {{1, 2, 3}, {1.01f, 2, 3}, {1, 2, 3.01f}};
    ps_vec3 normal = {0, -1, 0}, n = ps_normalize((ps_vec3){0.2f, 1, 0.1f}), origin = {0, 0, 0};
    double exact = (double)form_factor_triangle(origin, n, corners);
    double small = (double)form_factor_small(n, (ps_vec3){1.0033f, 2, 3.0033f}, normal, 5e-5f);
    expect_near("small, times 1e6", 1e6 * small, 1e6 * exact, 1e4 * exact);
}

/* The integral of a cosine by directions that are even over the solid angle is the form factor, and
 * all of them hit. */
static void test_directions_over_a_triangle(void **state)
{
    (void)state;
    enum { SIDE = 100 };
    const ps_vec3 corners[3] = {{-1, 0.5f, 0.2f}, {2, 0.7f, 0.1f}, {-0.5f, 1, 2}};
    const struct spherical_triangle triangle = spherical_triangle(corners);
    ps_vec3 n = {0, 0, 1}, across = ps_cross(ps_subtract(corners[1], corners[0]),
                                             ps_subtract(corners[2], corners[0]));
    double sum = 0;
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            float numbers[2] = {((float)i + 0.5f) / SIDE, ((float)j + 0.5f) / SIDE};
            ps_vec3 d = spherical_triangle_sample(&triangle, numbers);
            ps_vec3 hit = ps_scale(d, ps_dot(across, corners[0]) / ps_dot(across, d));
            for (int k = 0; k < 3; k++) {
                ps_vec3 edge = ps_subtract(corners[(k + 1) % 3], corners[k]);
                ps_vec3 inward = ps_cross(across, edge);
                assert_true(ps_dot(ps_subtract(hit, corners[k]), inward) > -1e-3f);
            }
            sum += (double)ps_dot(n, d);
        }
    double exact = (double)form_factor_triangle((ps_vec3){0, 0, 0}, n, corners);
    expect_near("by directions", sum / (SIDE * SIDE) * (double)triangle.solid_angle / PI, exact,
                1e-3 * exact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parallel_rectangle),
        cmocka_unit_test(test_wall_through_the_horizon),
        cmocka_unit_test(test_small_surface),
        cmocka_unit_test(test_directions_over_a_triangle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
