/* test_kernel_profile.c: tabulated filters integrate to 1 over their disc; bad ones are refused. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_profiles_integrate_to_one),
        cmocka_unit_test(test_bad_profiles_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
