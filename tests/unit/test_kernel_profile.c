/* test_kernel_profile.c: tabulated filters integrate to 1 over their disc, and know which part of
 * it lies before a straight border; bad ones are refused. */
#include "splat/kernel.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static void gaussian_profile(struct kernel_profile *profile)
{
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile->weights[i] = expf(-2.0f * kernel_profile_radius2(i));
    assert_true(kernel_profile_normalize(profile));
}

/* Scale of a profile over midpoints, and its integral over a grid of points in the unit disc. */
static void expect_normalized(struct kernel_profile *profile, double scale)
{
    enum { GRID = 1000 };
    assert_true(kernel_profile_normalize(profile));
    assert_true(fabs(profile->scale / scale - 1) < 1e-4);
    double sum = 0;
    for (int y = 0; y < GRID; y++)
        for (int x = 0; x < GRID; x++) {
            double u = (2.0 * x + 1) / GRID - 1, v = (2.0 * y + 1) / GRID - 1, r2 = u * u + v * v;
            if (r2 < 1)
                sum += profile->weights[(size_t)(r2 * KERNEL_PROFILE_SIZE)] * profile->scale;
        }
    assert_true(fabs(sum * 4 / (GRID * GRID) - 1) < 1e-3);
}

static void test_profiles_integrate_to_one(void **state)
{
    (void)state;
    const double pi = 3.14159265358979;
    struct kernel_profile profile;
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++) {
        assert_true(fabs(kernel_profile_radius2(i) - (i + 0.5) / KERNEL_PROFILE_SIZE) < 1e-7);
        profile.weights[i] = 5;
    }
    expect_normalized(&profile, 1 / (5 * pi));
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile.weights[i] = 1 - sqrtf(kernel_profile_radius2(i));
    expect_normalized(&profile, 3 / pi); /* a cone's volume is pi / 3 */
    gaussian_profile(&profile);
    expect_normalized(&profile, 2 / (pi * (1 - exp(-2))));
}

static void test_bad_profiles_are_refused(void **state)
{
    (void)state;
    static const float bad[] = {-1e-6f, NAN, INFINITY, -INFINITY};
    static const size_t places[] = {0, 500, KERNEL_PROFILE_SIZE - 1};
    struct kernel_profile profile;
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 3; k++) {
            gaussian_profile(&profile);
            profile.weights[places[k]] = bad[i];
            assert_false(kernel_profile_normalize(&profile));
        }
    memset(&profile, 0, sizeof profile);
    assert_false(kernel_profile_normalize(&profile));
    profile.weights[7] = 1; /* enough */
    assert_true(kernel_profile_normalize(&profile));
}

/* Half of every round kernel lies on each side of a border through its middle, and none of it
 * beyond one at its rim. */
static void expect_boundary(const struct kernel_profile *profile)
{
    const float *beyond = profile->beyond;
    assert_true(fabsf(beyond[0] - 0.5f) < 1e-4f);
    assert_true(fabsf(beyond[KERNEL_BOUNDARY_SIZE - 1]) < 1e-6f);
    for (size_t i = 1; i < KERNEL_BOUNDARY_SIZE; i++)
        assert_true(beyond[i] <= beyond[i - 1] && beyond[i] >= 0);
    /* Strictly, but for the last bits near the rim. */
    for (size_t i = 1; i < KERNEL_BOUNDARY_SIZE * 9 / 10; i++)
        assert_true(beyond[i] < beyond[i - 1]);
}

static void test_borders_cut_every_profile_by_its_part(void **state)
{
    (void)state;
    struct kernel_profile profile;
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile.weights[i] = 1 - sqrtf(kernel_profile_radius2(i));
    assert_true(kernel_profile_normalize(&profile));
    expect_boundary(&profile);
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile.weights[i] = 1 - kernel_profile_radius2(i);
    assert_true(kernel_profile_normalize(&profile));
    expect_boundary(&profile);
    gaussian_profile(&profile);
    expect_boundary(&profile);
}

/* Of an even disc, a border cuts off a segment. */
static void test_borders_cut_segments_off_a_disc(void **state)
{
    (void)state;
    const double pi = 3.14159265358979;
    struct kernel_profile profile;
    double worst = 0;
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        profile.weights[i] = 3; /* whatever the scale */
    assert_true(kernel_profile_normalize(&profile));
    expect_boundary(&profile);
    for (size_t i = 0; i < KERNEL_BOUNDARY_SIZE; i++) {
        double d = (double)i / (KERNEL_BOUNDARY_SIZE - 1);
        double expected = (acos(d) - d * sqrt(1 - d * d)) / pi;
        worst = fmax(worst, fabs(profile.beyond[i] - expected));
    }
    print_message("an even disc's borders: at most %.2g off\n", worst);
    assert_true(worst < 0.005);
}

/* The part of the profile that borders at distance d1 and d2 leave, whose normals are `angle`
 * apart: summed over a grid. */
static double part_left(const struct kernel_profile *profile, double d1, double d2, double angle)
{
    const int side = 800;
    double all = 0, left = 0;
    for (int i = 0; i < side * side; i++) {
        double u = (i % side + 0.5) / side * 2 - 1, v = (i / side + 0.5) / side * 2 - 1;
        double r2 = u * u + v * v;
        if (r2 >= 1)
            continue;
        double weight = profile->weights[(size_t)(r2 * KERNEL_PROFILE_SIZE)];
        all += weight;
        if (u < d1 && u * cos(angle) + v * sin(angle) < d2)
            left += weight;
    }
    return left / all;
}

static float beyond_at(const struct kernel_profile *profile, double distance)
{
    return profile->beyond[(size_t)(distance * (KERNEL_BOUNDARY_SIZE - 1) + 0.5)];
}

/* Through the middle it is exact, elsewhere within 4 % of the whole kernel. */
static void test_two_borders_leave_what_integration_finds(void **state)
{
    (void)state;
    struct kernel_profile profile;
    gaussian_profile(&profile);
    double at_middle = 0, worst = 0;
    for (int angle = 30; angle <= 150; angle += 30)
        for (int i = 0; i < 16; i++) {
            double radians = angle * 3.14159265358979 / 180, d1 = i % 4 * 0.2, d2 = i / 4 * 0.2;
            float likeness = (float)(2 / 3.14159265358979 * asin(cos(radians)));
            double left = kernel_left(beyond_at(&profile, d1), beyond_at(&profile, d2), likeness);
            double off = fabs(left - part_left(&profile, d1, d2, radians));
            if (i == 0)
                at_middle = fmax(at_middle, off);
            worst = fmax(worst, off);
        }
    print_message("off by %.4f at the middle, %.4f at most\n", at_middle, worst);
    assert_true(at_middle < 0.002);
    assert_true(worst < 0.04);
}

/* A quarter of the kernel lies beyond each border. */
static void test_two_borders_leave_what_lies_before_both(void **state)
{
    (void)state;
    assert_float_equal(kernel_left(0.25f, 0.25f, -1), 0.5, 1e-6f);   /* a strip */
    assert_float_equal(kernel_left(0.25f, 0.25f, 0), 0.5625, 1e-6f); /* a corner */
    assert_float_equal(kernel_left(0.25f, 0.25f, 1), 0.75, 1e-6f);   /* one border, twice */
    assert_float_equal(kernel_left(0.25f, 0.1f, 1), 0.75,
                       1e-6f); /* the nearer one hides the other */
    assert_float_equal(kernel_left(0.25f, 0, -0.3f), 0.75, 1e-6f); /* no other */
    assert_float_equal(kernel_left(0.5f, 0.5f, -1), 0.0625,
                       1e-6f); /* no more than sixteen times as bright */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_profiles_integrate_to_one),
        cmocka_unit_test(test_borders_cut_every_profile_by_its_part),
        cmocka_unit_test(test_borders_cut_segments_off_a_disc),
        cmocka_unit_test(test_two_borders_leave_what_integration_finds),
        cmocka_unit_test(test_two_borders_leave_what_lies_before_both),
        cmocka_unit_test(test_bad_profiles_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
