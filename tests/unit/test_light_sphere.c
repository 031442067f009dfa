/* test_light_sphere.c: spheres that shine, from far, near and inside. */
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

static const ps_rgb radiance = {6, 3, 2};
static const ps_vec3 center = {1, 2, 3};

static struct light ball(float radius, bool both_sides)
{
    return light_create_sphere(center, radius, radiance, both_sides);
}

/* The light from `distance` off its centre; `wide` degrees more than it fills. */
static struct light_view view_from(const struct light *light, double distance, double wide)
{
    const ps_vec3 from = {0.48f, -0.6f, 0.64f};
    double r = light->sphere.radius;
    double half = distance > r ? asin(r / distance) * 180 / PI + wide : 180;
    return (struct light_view){.light = light,
                               .position = ps_add_scaled(center, (float)distance, from),
                               .axis = ps_scale(from, -1),
                               .degrees = half,
                               .meet = meet_sphere,
                               .geometry = &light->sphere};
}

static void test_directions_have_their_density(void **state)
{
    (void)state;
    struct light light = ball(0.5f, false), both = ball(0.5f, true);
    static const double distances[] = {0.51, 0.6, 1, 4, 20};
    for (size_t i = 0; i < 5; i++) {
        struct light_view view = view_from(&light, distances[i], 0.2 / distances[i]);
        assert_true(light_view_fit(&view) > UNLIKELY);
        expect_samples_meet_light(&view, radiance);
        view.light = &both;
        assert_true(light_view_fit(&view) > UNLIKELY);
    }
    static const double inside[] = {0, 0.3, 0.45};
    for (size_t i = 0; i < 3; i++) {
        struct light_view view = view_from(&both, inside[i], 0);
        assert_true(light_view_fit(&view) > UNLIKELY);
        expect_samples_meet_light(&view, radiance);
    }
}

static void test_other_densities_are_rejected(void **state)
{
    (void)state;
    struct light light = ball(0.5f, true), other = ball(0.5f, true);
    other.sphere.center.x += 0.02f;
    struct light_view view = view_from(&other, 1, 5);
    view.position = view_from(&light, 1, 0).position;
    view.density = &light;
    view.geometry = &light.sphere;
    assert_true(light_view_fit(&view) < 1e-6);
    view = view_from(&other, 0.3, 0);
    view.density = &light;
    view.geometry = &light.sphere;
    assert_true(light_view_fit(&view) < 1e-6);
}

/* E = pi L (r / d)^2 for a surface that faces it: from next to it to so far that r^2 / d^2 is lost
 * beside 1. */
static void test_irradiance(void **state)
{
    (void)state;
    static const double distances[] = {0.5001, 0.7, 2, 50, 1e4, 1e7};
    struct light light = ball(0.5f, false);
    for (size_t i = 0; i < 6; i++) {
        double d = distances[i];
        struct light_view view = view_from(&light, d, 0);
        double exact = ps_length(ps_subtract(center, view.position));
        double expected = PI * 6 * 0.25 / (exact * exact);
        expect_close(irradiance_by_samples(&light, view.position, view.axis), expected, 1e-3);
        if (d < 1.5)
            continue;
        /* At 60 degrees to its normal, all of it above the horizon. */
        ps_vec3 u, v;
        ps_frame(view.axis, &u, &v);
        ps_vec3 normal = ps_add_scaled(ps_scale(view.axis, 0.5f), 0.8660254f, u);
        expect_close(irradiance_by_samples(&light, view.position, normal), 0.5 * expected, 1e-3);
    }
}

/* In a furnace the irradiance is pi L anywhere, and nothing where only the outside shines. */
static void test_irradiance_inside(void **state)
{
    (void)state;
    struct light both = ball(0.5f, true), light = ball(0.5f, false);
    static const double distances[] = {0, 0.2, 0.45};
    for (size_t i = 0; i < 3; i++) {
        struct light_view view = view_from(&both, distances[i], 0);
        ps_vec3 normal = {0.6f, 0, 0.8f};
        expect_close(irradiance_by_samples(&both, view.position, normal), PI * 6, 1e-2);
        assert_true(irradiance_by_samples(&light, view.position, normal) == 0);
        float distance;
        meet_sphere(&both.sphere, view.position, normal, &distance, &view.axis);
        assert_true(light_pdf(&light, view.position, normal, distance, view.axis) == 0);
    }
}

static void test_power(void **state)
{
    (void)state;
    struct light light = ball(0.5f, false), both = ball(0.5f, true);
    expect_close(light_power(&light).r, PI * 6 * 4 * PI * 0.25, 1e-6);
    expect_close(light_power(&both).g, 2 * PI * 3 * 4 * PI * 0.25, 1e-6);
    expect_flux_is_power(&light, 1e-5);
    expect_flux_is_power(&both, 1e-5);
    assert_false(light_is_delta(&light));
}

/* Even over the sphere: 4 heights, 4 sectors; cosine distributed about the normal: 4 rings of the
 * squared sine, 4 sectors; and the sides. */
static void expect_emission(const struct light *light, size_t sides)
{
    enum { RAYS = 400000, MOST = 512 };
    double observed[MOST] = {0}, expected[MOST];
    size_t cells = 256 * sides;
    struct random random = {7};
    for (int i = 0; i < RAYS; i++) {
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = random_unit(&random);
        ps_ray ray;
        ps_vec3 normal, x, y;
        light_emit(light, u, &ray, &normal);
        ps_vec3 out = ps_scale(ps_subtract(ray.origin, center), 2);
        bool is_inward = ps_dot(out, normal) < 0;
        assert_true(fabsf(ps_length(out) - 1) < 1e-5f);
        assert_true(fabsf(fabsf(ps_dot(out, normal)) - 1) < 1e-5f);
        assert_true(ps_dot(ray.direction, normal) >= -1e-6f);
        assert_true(!is_inward || sides == 2);
        ps_frame(normal, &x, &y);
        double cosine = ps_dot(ray.direction, normal);
        double turn = atan2(ps_dot(ray.direction, y), ps_dot(ray.direction, x)) / (2 * PI) + 0.5;
        double around = atan2(out.z, out.x) / (2 * PI) + 0.5;
        size_t cell = (size_t)fmin((out.y + 1) * 2, 3);
        cell = cell * 4 + (size_t)fmin(around * 4, 3);
        cell = cell * 4 + (size_t)fmin(fmax(0, 1 - cosine * cosine) * 4, 3);
        cell = cell * 4 + (size_t)fmin(turn * 4, 3);
        observed[cell + (is_inward ? 256 : 0)]++;
    }
    for (size_t i = 0; i < cells; i++)
        expected[i] = (double)RAYS / (double)cells;
    assert_true(chi_squared_probability(observed, expected, cells) > UNLIKELY);
}

static void test_emission_is_lambertian(void **state)
{
    (void)state;
    struct light light = ball(0.5f, false), both = ball(0.5f, true);
    expect_emission(&light, 1);
    expect_emission(&both, 2);
}

static void test_photons_agree_with_samples(void **state)
{
    (void)state;
    struct light light = ball(0.5f, false), both = ball(0.5f, true);
    expect_plate_agrees(&light, (ps_vec3){1, 1, 3}, (ps_vec3){0.6f, 0.8f, 0}, 0.15);
    expect_plate_agrees(&both, (ps_vec3){1.1f, 1.9f, 3}, (ps_vec3){0.6f, 0.8f, 0}, 0.08);
}

/* The side that faces away is hidden from outside, and not chosen. */
static void test_far_side_has_no_density(void **state)
{
    (void)state;
    struct light both = ball(0.5f, true);
    const ps_vec3 position = {1, 2, 0}, ahead = {0, 0, 1}, near = {0, 0, -1};
    expect_close(light_pdf(&both, position, ahead, 2.5f, near), 1 / (2 * PI * (1 - sqrt(35) / 6)),
                 1e-4);
    assert_true(light_pdf(&both, position, ahead, 3.5f, ahead) == 0);
}

static void test_no_size(void **state)
{
    (void)state;
    struct light light = ball(0, true);
    struct light_sample sample;
    assert_true(light_power(&light).r == 0);
    assert_false(sample_light(&light, (ps_vec3){0, 0, 0}, 0.5f, 0.5f, &sample));
    assert_false(sample_light(&light, center, 0.5f, 0.5f, &sample));
    assert_true(light_pdf(&light, center, (ps_vec3){0, 0, 1}, 0, (ps_vec3){0, 0, 1}) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directions_have_their_density),
        cmocka_unit_test(test_other_densities_are_rejected),
        cmocka_unit_test(test_irradiance),
        cmocka_unit_test(test_irradiance_inside),
        cmocka_unit_test(test_power),
        cmocka_unit_test(test_emission_is_lambertian),
        cmocka_unit_test(test_photons_agree_with_samples),
        cmocka_unit_test(test_far_side_has_no_density),
        cmocka_unit_test(test_no_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
