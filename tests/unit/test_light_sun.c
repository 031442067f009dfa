/* test_light_sun.c: light from one direction, or from a disc in the sky. The scene is the sphere of
 * radius 5 around (1, 2, 3). */
#include "scene/light.h"

#include "support/chi_squared.h"
#include "support/light_check.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define UNLIKELY 1e-4

static const ps_vec3 center = {1, 2, 3}, towards = {0, 0.8f, 0.6f};

static struct light sun(double angle, enum light_unit unit)
{
    const struct light_description description = {.kind = LIGHT_SUN,
                                                  .direction = {0, -4, -3},
                                                  .angle = angle,
                                                  .amount = {6, 3, 2},
                                                  .unit = unit};
    return light_of(&description, NULL);
}

static const double angles[] = {0.01, 0.53, 10, 60, 180};
#define ANGLES (sizeof angles / sizeof angles[0])

static struct light_view view_of(const struct light *light, double degrees)
{
    return (struct light_view){
        .light = light, .axis = towards, .degrees = degrees, .meet = meet_infinity};
}

static void test_directions_have_their_density(void **state)
{
    (void)state;
    for (size_t i = 1; i < ANGLES; i++) {
        struct light light = sun(angles[i], UNIT_RADIANCE);
        struct light_view view = view_of(&light, angles[i] / 2 * 1.02);
        expect_samples_meet_light(&view, (ps_rgb){6, 3, 2});
        assert_true(light_view_fit(&view) > UNLIKELY);
        view.of_emission = true;
        assert_true(light_view_fit(&view) > UNLIKELY);
        /* The test would see a sun that is a little elsewhere. */
        struct light other = light;
        other.sun.towards = ps_normalize((ps_vec3){(float)(angles[i] * 2e-4), 0.8f, 0.6f});
        view.density = &other;
        assert_true(light_view_fit(&view) < 1e-6);
    }
}

/* A surface that faces it gets E = pi L sin^2 of half the angle; others the cosine of that. */
static void test_irradiance(void **state)
{
    (void)state;
    const ps_vec3 tilted = {0.8f, 0.48f, 0.36f}; /* cosine 0.6 */
    for (size_t i = 0; i < ANGLES; i++) {
        double sine = sin(angles[i] * PI / 360);
        struct light light = sun(angles[i], UNIT_RADIANCE), even = sun(angles[i], UNIT_IRRADIANCE);
        expect_close(irradiance_by_samples(&light, center, towards), PI * 6 * sine * sine, 1e-4);
        expect_close(irradiance_by_samples(&even, center, towards), 6, 1e-4);
        expect_close(light_radiance_from(&even, towards).g, 3 / (PI * sine * sine), 1e-4);
        if (angles[i] < 90)
            expect_close(irradiance_by_samples(&even, center, tilted), 0.6 * 6, 1e-4);
    }
}

static void test_a_point(void **state)
{
    (void)state;
    struct light light = sun(0, UNIT_IRRADIANCE);
    struct light_sample sample;
    assert_true(light_is_delta(&light));
    assert_true(sample_light(&light, center, 0.2f, 0.9f, &sample));
    assert_true(isinf(sample.distance) && sample.pdf == 0);
    assert_true(sample.weight.r == 6 && sample.weight.g == 3 && sample.weight.b == 2);
    expect_close(ps_dot(sample.direction, towards), 1, 1e-6);
    assert_true(light_radiance_from(&light, towards).r == 0);
    assert_true(light_pdf(&light, center, towards, INFINITY, towards) == 0);
    expect_close(irradiance_by_samples(&light, center, (ps_vec3){0, 1, 0}), 0.8 * 6, 1e-5);
    expect_close(light_power(&light).r, 6 * PI * 25, 1e-6);
    expect_flux_is_power(&light, 1e-5);
    struct light narrow = sun(1e-9, UNIT_IRRADIANCE);
    assert_true(light_is_delta(&narrow));
    struct light real = sun(0.53, UNIT_IRRADIANCE);
    assert_false(light_is_delta(&real));
}

static void test_is_seen_as_a_disc(void **state)
{
    (void)state;
    for (size_t i = 0; i < ANGLES - 1; i++) {
        struct light light = sun(angles[i], UNIT_RADIANCE);
        for (double share = 0; share < 2; share += 0.07) {
            double tilt = share * angles[i] * PI / 360;
            ps_vec3 direction = ps_scale(towards, (float)cos(tilt));
            direction.x = (float)sin(tilt);
            assert_true(light_radiance_from(&light, direction).r == (share < 1 ? 6 : 0));
        }
        assert_true(light_radiance_from(&light, ps_scale(towards, -1)).r == 0);
    }
}

static void test_power(void **state)
{
    (void)state;
    for (size_t i = 0; i < ANGLES; i++) {
        struct light light = sun(angles[i], UNIT_RADIANCE);
        double half = sin(angles[i] * PI / 720), solid_angle = 4 * PI * half * half;
        expect_close(light_power(&light).r, 6 * solid_angle * PI * 25, 1e-5);
        expect_flux_is_power(&light, 1e-5);
    }
}

/* Rays start outside of the scene's sphere and cross it within its radius, evenly over the disc: 8
 * rings of equal area and 16 sectors, around the direction of the ray itself. */
static void test_rays_fill_the_scene(void **state)
{
    (void)state;
    enum { RAYS = 200000, RINGS = 8, SECTORS = 16 };
    static const double wide[] = {0, 0.53, 60};
    for (size_t i = 0; i < 3; i++) {
        struct light light = sun(wide[i], UNIT_IRRADIANCE);
        double observed[RINGS * SECTORS] = {0}, expected[RINGS * SECTORS];
        struct random random = {43};
        for (int k = 0; k < RAYS; k++) {
            float u[4];
            for (int j = 0; j < 4; j++)
                u[j] = random_unit(&random);
            ps_ray ray;
            ps_vec3 normal, x, y;
            light_emit(&light, u, &ray, &normal);
            assert_true(normal.x == 0 && normal.y == 0 && normal.z == 0);
            ps_vec3 from = ps_subtract(ray.origin, center);
            assert_true(ps_length(from) > 5 && ps_dot(from, ray.direction) < -5);
            ps_frame(ray.direction, &x, &y);
            double a = ps_dot(from, x) / 5, b = ps_dot(from, y) / 5;
            assert_true(a * a + b * b < 1 + 1e-5);
            size_t ring = (size_t)fmin((a * a + b * b) * RINGS, RINGS - 1);
            double turn = atan2(b, a) / (2 * PI) + 0.5;
            observed[ring * SECTORS + (size_t)fmin(turn * SECTORS, SECTORS - 1)]++;
        }
        for (size_t k = 0; k < RINGS * SECTORS; k++)
            expected[k] = (double)RAYS / (RINGS * SECTORS);
        assert_true(chi_squared_probability(observed, expected, RINGS * SECTORS) > UNLIKELY);
    }
}

static void test_photons_agree_with_samples(void **state)
{
    (void)state;
    for (size_t i = 0; i < ANGLES; i++) {
        struct light light = sun(angles[i], UNIT_IRRADIANCE);
        expect_plate_agrees(&light, (ps_vec3){2, 1, 4}, (ps_vec3){0.6f, 0.8f, 0}, 1);
    }
    struct light light = sun(0, UNIT_IRRADIANCE);
    expect_plate_agrees(&light, (ps_vec3){2, 1, 4}, (ps_vec3){0.6f, 0.8f, 0}, 1);
}

static void test_refusals(void **state)
{
    (void)state;
    struct light light;
    struct error error = {""};
    const struct light_bounds bounds = {{0, 0, 0}, 1};
    struct light_description description = {
        .kind = LIGHT_SUN, .direction = {0, -1, 0}, .amount = {1, 1, 1}, .unit = UNIT_RADIANCE};
    assert_int_equal(light_create(&description, &bounds, NULL, &light, &error), PS_ERROR_INVALID);
    description.unit = UNIT_POWER;
    assert_int_equal(light_create(&description, &bounds, NULL, &light, &error), PS_ERROR_INVALID);
    description.unit = UNIT_IRRADIANCE;
    description.direction.y = 0;
    assert_int_equal(light_create(&description, &bounds, NULL, &light, &error), PS_ERROR_INVALID);
    assert_true(error.text[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directions_have_their_density),
        cmocka_unit_test(test_irradiance),
        cmocka_unit_test(test_a_point),
        cmocka_unit_test(test_is_seen_as_a_disc),
        cmocka_unit_test(test_power),
        cmocka_unit_test(test_rays_fill_the_scene),
        cmocka_unit_test(test_photons_agree_with_samples),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
