/* test_light_limits.c: whatever the sizes, places and numbers, no light gives a NaN, an infinite
 * flux, or a direction without length. */
#include "scene/light.h"

#include "support/light_check.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define LAST (1.0f - 0x1p-24f)

static bool is_finite(ps_vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

static bool is_light(ps_rgb a)
{
    return isfinite(a.r) && isfinite(a.g) && isfinite(a.b) && a.r >= 0 && a.g >= 0 && a.b >= 0;
}

/* Often an end of the range. */
static float hostile_unit(struct random *random)
{
    float u = random_unit(random);
    return u < 0.15f ? 0 : (u < 0.3f ? LAST : (u < 0.4f ? 0.5f : random_unit(random)));
}

static float magnitude(struct random *random)
{
    return powf(10, random_between(random, -9, 9));
}

static ps_vec3 hostile_point(struct random *random)
{
    if (random_unit(random) < 0.2f)
        return (ps_vec3){0, 0, 0};
    return ps_scale(random_direction(random), magnitude(random));
}

static void check_light(const struct light *light, struct random *random)
{
    assert_true(is_light(light_power(light)));
    for (int i = 0; i < 20; i++) {
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = hostile_unit(random);
        ps_ray ray;
        ps_vec3 normal, position = hostile_point(random);
        assert_true(is_light(light_emit(light, u, &ray, &normal)));
        assert_true(is_finite(ray.origin) && fabsf(ps_length(ray.direction) - 1) < 1e-4f);
        struct light_sample sample;
        if (sample_light(light, position, u[0], u[1], &sample)) {
            assert_true(is_light(sample.weight) && ps_rgb_maximum(sample.weight) > 0);
            assert_true(fabsf(ps_length(sample.direction) - 1) < 1e-4f);
            assert_true(sample.distance >= 0 && sample.pdf >= 0 && isfinite(sample.pdf));
        }
        ps_vec3 direction = random_direction(random);
        float distance = i % 2 ? 0 : magnitude(random);
        float pdf = light_pdf(light, position, direction, distance, random_direction(random));
        assert_true(pdf >= 0 && isfinite(pdf));
        assert_true(is_light(light_radiance_from(light, direction)));
    }
}

static void test_points_and_spots(void **state)
{
    (void)state;
    struct random random = {61};
    for (int i = 0; i < 2000; i++) {
        double falloff = random_between(&random, 0.1f, 90);
        const struct light_description description = {.kind = i % 3 ? LIGHT_SPOT : LIGHT_POINT,
                                                      .amount = {magnitude(&random), 0, 1},
                                                      .unit = i % 2 ? UNIT_POWER : UNIT_INTENSITY,
                                                      .point_at =
                                                          ps_scale(random_direction(&random), 3),
                                                      .radius = falloff * random_unit(&random),
                                                      .falloff = falloff,
                                                      .tightness = i % 5 ? magnitude(&random) : 0};
        struct light light;
        struct error error;
        const struct light_bounds bounds = {{0, 0, 0}, 1};
        if (light_create(&description, &bounds, NULL, &light, &error) == PS_OK)
            check_light(&light, &random);
    }
}

static void test_suns_and_skies(void **state)
{
    (void)state;
    struct random random = {67};
    for (int i = 0; i < 2000; i++) {
        float rgb[6][3];
        for (int k = 0; k < 18; k++)
            rgb[k / 3][k % 3] = random_unit(&random) < 0.5f ? 0 : magnitude(&random);
        struct sky_picture picture = {i % 3 + 1, i % 2 + 1, (const float(*)[3])rgb};
        const struct light_description description = {
            .kind = i % 2 ? LIGHT_SKY : LIGHT_SUN,
            .amount = {magnitude(&random), 0, 1},
            .unit = i % 2 ? UNIT_RADIANCE : UNIT_IRRADIANCE,
            .direction = random_direction(&random),
            .rotate = random_between(&random, -1000, 1000),
            .angle = i % 4 ? fminf(magnitude(&random), 180) : 0};
        const struct light_bounds bounds = {hostile_point(&random), i % 7 ? magnitude(&random) : 0};
        struct light light;
        struct error error;
        assert_int_equal(
            light_create(&description, &bounds, i % 5 ? &picture : NULL, &light, &error), PS_OK);
        check_light(&light, &random);
        light_release(&light);
    }
}

static void test_surfaces(void **state)
{
    (void)state;
    struct random random = {71};
    for (int i = 0; i < 2000; i++) {
        ps_vec3 vertices[6];
        float size = magnitude(&random);
        for (int k = 0; k < 6; k++)
            vertices[k] = ps_scale(random_direction(&random), k % 2 ? size : magnitude(&random));
        static const uint32_t triangles[3][3] = {{0, 1, 2}, {3, 4, 5}, {2, 2, 3}};
        struct light_mesh mesh = {
            .vertices = vertices, .triangles = triangles, .triangle_count = (size_t)i % 4};
        struct light light;
        struct error error;
        ps_rgb radiance = {magnitude(&random), 0, i % 3 ? 1 : 0};
        assert_int_equal(light_create_mesh(&mesh, radiance, i % 2, &light, &error), PS_OK);
        check_light(&light, &random);
        light_release(&light);
        light = light_create_sphere(hostile_point(&random), i % 5 ? size : 0, radiance, i % 2);
        check_light(&light, &random);
    }
}

/* At its centre, on it, and next to it. */
static void test_points_of_a_sphere(void **state)
{
    (void)state;
    struct random random = {73};
    for (int i = 0; i < 20000; i++) {
        struct light light =
            light_create_sphere((ps_vec3){1, 2, 3}, 0.5f, (ps_rgb){1, 1, 1}, i % 2);
        float off = 0.5f * (1 + random_between(&random, -3e-7f, 3e-7f));
        ps_vec3 position = ps_add_scaled((ps_vec3){1, 2, 3}, off, random_direction(&random));
        struct light_sample sample;
        if (sample_light(&light, position, hostile_unit(&random), hostile_unit(&random), &sample)) {
            assert_true(is_light(sample.weight) && isfinite(sample.pdf) && sample.distance >= 0);
            assert_true(fabsf(ps_length(sample.direction) - 1) < 1e-4f);
        }
    }
}

/* More than a float holds is refused where that is possible, and dark where it is not. */
static void test_overflow(void **state)
{
    (void)state;
    static const ps_vec3 vertices[] = {{0, 0, 0}, {1e3f, 0, 0}, {0, 1e3f, 0}};
    static const ps_vec3 vast[] = {{0, 0, 0}, {1e30f, 0, 0}, {0, 1e30f, 0}};
    static const uint32_t triangles[][3] = {{0, 1, 2}};
    const ps_rgb bright = {1e38f, 1, 1}, dim = {1, 1, 1};
    struct light_mesh mesh = {.vertices = vertices, .triangles = triangles, .triangle_count = 1};
    struct light light;
    struct error error = {""};
    assert_int_equal(light_create_mesh(&mesh, bright, false, &light, &error), PS_ERROR_INVALID);
    assert_int_equal(light_create_mesh(&mesh, dim, false, &light, &error), PS_OK);
    light_release(&light);
    mesh.vertices = vast;
    assert_int_equal(light_create_mesh(&mesh, dim, false, &light, &error), PS_ERROR_INVALID);
    const struct light_description description = {
        .kind = LIGHT_SUN, .direction = {0, -1, 0}, .amount = bright, .unit = UNIT_IRRADIANCE};
    const struct light_bounds bounds = {{0, 0, 0}, 100};
    assert_int_equal(light_create(&description, &bounds, NULL, &light, &error), PS_ERROR_INVALID);
    const float u[4] = {0.1f, 0.2f, 0.3f, 0.4f};
    ps_ray ray;
    ps_vec3 normal;
    light = light_create_sphere((ps_vec3){0, 0, 0}, 100, bright, false);
    assert_true(light_emit(&light, u, &ray, &normal).r == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points_and_spots), cmocka_unit_test(test_suns_and_skies),
        cmocka_unit_test(test_surfaces),         cmocka_unit_test(test_points_of_a_sphere),
        cmocka_unit_test(test_overflow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
