/* test_math.c: frames, and directions by chi-squared against the densities they promise. */
#include "support/chi_squared.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define RINGS 12
#define SECTORS 16
#define CELLS (RINGS * SECTORS)
#define DIRECTIONS 100000
#define UNLIKELY 1e-4

static void expect_frame(ps_vec3 w)
{
    ps_vec3 u, v;
    ps_frame(w, &u, &v);
    assert_true(fabsf(ps_length(u) - 1) < 2e-6f && fabsf(ps_length(v) - 1) < 2e-6f);
    assert_true(fabsf(ps_dot(u, v)) < 1e-6f);
    assert_true(fabsf(ps_dot(u, w)) < 1e-6f && fabsf(ps_dot(v, w)) < 1e-6f);
    assert_true(ps_dot(ps_cross(u, v), w) > 0.999f); /* right-handed */
}

static void test_frame_is_orthonormal(void **state)
{
    (void)state;
    struct random random = {1};
    for (int i = 0; i < 100000; i++)
        expect_frame(ps_normalize(random_direction(&random)));
}

static void test_frame_near_the_poles(void **state)
{
    (void)state;
    static const ps_vec3 axes[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0},    {-1, 0, 0},
                                   {0, 1, 0}, {0, -1, 0}, {1, 0, 0.0f}, {1, 0, -0.0f}};
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; i++)
        expect_frame(axes[i]);
    for (float tilt = 1e-1f; tilt > 1e-30f; tilt *= 0.3f)
        for (int pole = -1; pole <= 1; pole += 2) {
            expect_frame(ps_normalize((ps_vec3){tilt, -2 * tilt, (float)pole}));
            expect_frame(ps_normalize((ps_vec3){-tilt, 0, (float)pole}));
            expect_frame(ps_normalize((ps_vec3){1, tilt, (float)pole * tilt}));
        }
}

/* Which of CELLS a direction falls into around `axis`: rings of equal range in the cosine, between
 * cos_limit and 1, and sectors. The frame is the test's own. */
static size_t cell_of(ps_vec3 axis, double cos_limit, ps_vec3 direction)
{
    ps_vec3 helper = fabsf(axis.x) < 0.5f ? (ps_vec3){1, 0, 0} : (ps_vec3){0, 1, 0};
    ps_vec3 u = ps_normalize(ps_cross(helper, axis)), v = ps_cross(axis, u);
    assert_true(fabsf(ps_length(direction) - 1) < 1e-5f);
    double height = (ps_dot(direction, axis) - cos_limit) / (1 - cos_limit);
    assert_true(height > -1e-4);
    double turn = atan2(ps_dot(direction, v), ps_dot(direction, u)) / (2 * 3.14159265358979) + 0.5;
    size_t ring = (size_t)fmin(fmax(height * RINGS, 0), RINGS - 1);
    return ring * SECTORS + (size_t)fmin(turn * SECTORS, SECTORS - 1);
}

/* Shares of the rings: for the density cos/pi over the hemisphere, and for a uniform one. */
static double cosine_share(size_t ring)
{
    return (2.0 * (double)ring + 1) / (RINGS * RINGS);
}

static double even_share(size_t ring)
{
    (void)ring;
    return 1.0 / RINGS;
}

typedef ps_vec3 (*direction_function)(ps_vec3 axis, float cos_limit, float u1, float u2);

static ps_vec3 cosine_direction(ps_vec3 axis, float cos_limit, float u1, float u2)
{
    (void)cos_limit;
    return ps_cosine_direction(axis, u1, u2);
}

/* Wrong: even in the angle from the axis instead of its cosine. */
static ps_vec3 angle_direction(ps_vec3 axis, float cos_limit, float u1, float u2)
{
    return ps_cone_direction(axis, cosf(u1 * acosf(cos_limit)), 1, u2);
}

/* Wrong: some sectors are preferred. */
static ps_vec3 lopsided_direction(ps_vec3 axis, float cos_limit, float u1, float u2)
{
    return ps_cone_direction(axis, cos_limit, u1, u2 + 0.01f * sinf(6 * u2));
}

static double fit(direction_function make, double (*share)(size_t ring), ps_vec3 axis,
                  float cos_limit)
{
    double observed[CELLS] = {0}, expected[CELLS];
    struct random random = {2};
    for (int i = 0; i < DIRECTIONS; i++) {
        float u1 = random_unit(&random), u2 = random_unit(&random);
        observed[cell_of(axis, cos_limit, make(axis, cos_limit, u1, u2))]++;
    }
    for (size_t i = 0; i < CELLS; i++)
        expected[i] = DIRECTIONS * share(i / SECTORS) / SECTORS;
    return chi_squared_probability(observed, expected, CELLS);
}

static const ps_vec3 fit_axes[] = {{0, 0, 1},  {0, 0, -1},       {0, 1, 0},
                                   {-1, 0, 0}, {0.6f, 0, -0.8f}, {0.48f, -0.6f, 0.64f}};
#define FIT_AXES (sizeof fit_axes / sizeof fit_axes[0])

static void test_cosine_direction_has_its_density(void **state)
{
    (void)state;
    for (size_t i = 0; i < FIT_AXES; i++)
        assert_true(fit(cosine_direction, cosine_share, fit_axes[i], 0) > UNLIKELY);
}

static void test_cone_direction_has_its_density(void **state)
{
    (void)state;
    static const float limits[] = {0.5f, 0.0f, -1.0f, 0.9f};
    for (size_t i = 0; i < FIT_AXES; i++)
        for (size_t k = 0; k < 4; k++)
            assert_true(fit(ps_cone_direction, even_share, fit_axes[i], limits[k]) > UNLIKELY);
}

/* The test would see a mismatch. */
static void test_wrong_densities_are_rejected(void **state)
{
    (void)state;
    for (size_t i = 0; i < FIT_AXES; i++) {
        assert_true(fit(ps_cone_direction, cosine_share, fit_axes[i], 0) < 1e-12);
        assert_true(fit(cosine_direction, even_share, fit_axes[i], 0) < 1e-12);
        assert_true(fit(angle_direction, even_share, fit_axes[i], 0.5f) < 1e-12);
        assert_true(fit(lopsided_direction, even_share, fit_axes[i], 0.5f) < 1e-6);
    }
}

static void test_chi_squared_tail(void **state)
{
    (void)state;
    /* Table values. */
    assert_true(fabs(chi_squared_tail(3.841459, 1) - 0.05) < 1e-6);
    assert_true(fabs(chi_squared_tail(18.307038, 10) - 0.05) < 1e-6);
    assert_true(fabs(chi_squared_tail(2.558212, 10) - 0.99) < 1e-6);
    assert_true(fabs(chi_squared_tail(135.806723, 100) - 0.01) < 1e-6);
    assert_true(fabs(chi_squared_tail(2, 2) - exp(-1)) < 1e-12);
}

static void test_directions_at_the_ends_of_the_range(void **state)
{
    (void)state;
    const float last = 1.0f - 0x1p-24f;
    ps_vec3 n = {0, -1, 0};
    assert_true(ps_dot(ps_cosine_direction(n, 0, 0), n) > 0.999999f);
    assert_true(ps_dot(ps_cosine_direction(n, last, 0.3f), n) >= 0);
    assert_true(ps_dot(ps_cone_direction(n, 0.5f, 0, 0.9f), n) > 0.999999f);
    assert_true(ps_dot(ps_cone_direction(n, 0.5f, last, 0.9f), n) > 0.499999f);
    assert_true(ps_dot(ps_cone_direction(n, 1.0f, last, 0.9f), n) > 0.999999f);
}

static void test_vectors_and_colours(void **state)
{
    (void)state;
    ps_vec3 z = ps_cross((ps_vec3){1, 0, 0}, (ps_vec3){0, 1, 0});
    assert_true(z.x == 0 && z.y == 0 && z.z == 1);
    ps_vec3 sum = ps_add_scaled((ps_vec3){1, 2, 3}, 2, (ps_vec3){4, 5, 6});
    assert_true(sum.x == 9 && sum.y == 12 && sum.z == 15);
    assert_true(ps_length((ps_vec3){2, 3, 6}) == 7);
    assert_true(fabsf(ps_luminance((ps_rgb){1, 1, 1}) - 1) < 1e-6f);
    assert_true(ps_luminance((ps_rgb){0, 1, 0}) > ps_luminance((ps_rgb){1, 0, 0}));
    assert_true(ps_rgb_maximum((ps_rgb){1, 3, 2}) == 3 && ps_rgb_maximum((ps_rgb){4, 3, 2}) == 4 &&
                ps_rgb_maximum((ps_rgb){1, 3, 5}) == 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chi_squared_tail),
        cmocka_unit_test(test_vectors_and_colours),
        cmocka_unit_test(test_frame_is_orthonormal),
        cmocka_unit_test(test_frame_near_the_poles),
        cmocka_unit_test(test_cosine_direction_has_its_density),
        cmocka_unit_test(test_cone_direction_has_its_density),
        cmocka_unit_test(test_wrong_densities_are_rejected),
        cmocka_unit_test(test_directions_at_the_ends_of_the_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
