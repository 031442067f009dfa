/* test_light_sky.c: light from all around, of one colour or of a picture. The scene is the sphere
 * of radius 5 around (1, 2, 3). */
#include "scene/light.h"

#include "support/light_check.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define UNLIKELY 1e-4

static const ps_vec3 up = {0, 1, 0}, tilted = {0.6f, 0, 0.8f};

static struct light sky_of(const struct sky_picture *picture, double rotate)
{
    const struct light_description description = {
        .kind = LIGHT_SKY, .amount = {2, 1, 0.5f}, .unit = UNIT_RADIANCE, .rotate = rotate};
    return light_of(&description, picture);
}

/* A dim sky with a bright patch, a brighter pixel, and the lower half of `night`. */
static struct sky_picture spotted(float night)
{
    enum { WIDTH = 24, HEIGHT = 12 };
    static float rgb[WIDTH * HEIGHT][3];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        bool is_patch = x >= 5 && x < 9 && y >= 3 && y < 6, is_pixel = x == 23 && y == 7;
        float value = is_pixel ? 60 : (is_patch ? 12 : (y < 6 ? 0.5f : night));
        rgb[i][0] = value;
        rgb[i][1] = value * 0.5f;
        rgb[i][2] = y == 11 ? 0.3f : value * 0.1f;
    }
    return (struct sky_picture){WIDTH, HEIGHT, (const float(*)[3])rgb};
}

/* Shadows of an even sky are soft, and of one with a patch as wide as a hand's span, but not of one
 * with a sun. */
static void test_softness(void **state)
{
    (void)state;
    struct sky_picture picture = spotted(0.5f);
    struct light even = sky_of(NULL, 0), with_patch = sky_of(&picture, 0);
    assert_true(light_is_soft(&even));
    assert_true(light_is_soft(&with_patch));
    static float rgb[64 * 32][3];
    for (int i = 0; i < 64 * 32; i++)
        rgb[i][0] = rgb[i][1] = rgb[i][2] = i == 10 * 64 + 7 ? 1000.0f : 1.0f;
    struct sky_picture sunny = {64, 32, (const float(*)[3])rgb};
    struct light with_sun = sky_of(&sunny, 0);
    assert_false(light_is_soft(&with_sun));
    light_release(&even);
    light_release(&with_patch);
    light_release(&with_sun);
}

/* --- densities --- */

static struct light_view view_of(const struct light *light, ps_vec3 axis)
{
    return (struct light_view){.light = light, .axis = axis, .degrees = 180, .meet = meet_infinity};
}

static void test_directions_have_their_density(void **state)
{
    (void)state;
    struct sky_picture picture = spotted(1e-3f); /* samples that see black are not lit */
    struct light lights[] = {sky_of(NULL, 0), sky_of(&picture, 0), sky_of(&picture, 77)};
    for (size_t i = 0; i < 3; i++) {
        struct light_view view = view_of(&lights[i], i == 2 ? tilted : up);
        assert_true(light_view_fit(&view) > UNLIKELY);
        view.of_emission = true;
        assert_true(light_view_fit(&view) > UNLIKELY);
    }
    /* The test would see a picture that is turned a little. */
    struct light other = sky_of(&picture, 78);
    struct light_view view = view_of(&lights[2], tilted);
    view.density = &other;
    assert_true(light_view_fit(&view) < 1e-6);
    light_release(&other);
    for (size_t i = 0; i < 3; i++)
        light_release(&lights[i]);
}

/* Each weight is the radiance seen in its direction over the density; where there is light, there
 * is density. */
static void test_samples(void **state)
{
    (void)state;
    struct sky_picture picture = spotted(0);
    struct light lights[] = {sky_of(NULL, 0), sky_of(&picture, -30)};
    struct random random = {47};
    for (int i = 0; i < 20000; i++) {
        const struct light *light = &lights[i % 2];
        struct light_sample sample;
        float u1 = random_unit(&random), u2 = random_unit(&random);
        ps_vec3 any = random_direction(&random), nowhere = {0, 0, 0};
        assert_true(light_radiance_from(light, any).g == 0 ||
                    light_pdf(light, nowhere, any, INFINITY, nowhere) > 0);
        if (!sample_light(light, nowhere, u1, u2, &sample))
            continue;
        ps_rgb radiance = light_radiance_from(light, sample.direction);
        assert_true(isinf(sample.distance));
        expect_close(ps_length(sample.direction), 1, 1e-5);
        expect_close(sample.weight.r * sample.pdf, radiance.r, 1e-5);
        expect_close(sample.weight.b * sample.pdf, radiance.b, 1e-5);
    }
    light_release(&lights[1]);
}

/* But where rounding puts a direction into the next cell. */
static void test_density_of_samples_is_that_of_their_direction(void **state)
{
    (void)state;
    struct sky_picture picture = spotted(0);
    struct light light = sky_of(&picture, 123);
    struct random random = {53};
    int different = 0;
    for (int i = 0; i < 100000; i++) {
        struct light_sample sample;
        ps_vec3 nowhere = {0, 0, 0};
        sample_light(&light, nowhere, random_unit(&random), random_unit(&random), &sample);
        float pdf = light_pdf(&light, nowhere, sample.direction, INFINITY, nowhere);
        different += fabsf(pdf - sample.pdf) > 1e-5f * sample.pdf;
    }
    assert_true(different < 10);
    light_release(&light);
}

/* Before a surface that takes light by the cosine, all samples of an even sky tell its irradiance;
 * those of a picture do not change. */
static void test_by_the_cosine(void **state)
{
    (void)state;
    struct sky_picture picture = spotted(0);
    struct light lights[] = {sky_of(NULL, 0), sky_of(&picture, 0)};
    struct random random = {59};
    ps_vec3 nowhere = {0, 0, 0}, normal = ps_normalize((ps_vec3){1, 2, -2});
    ps_rgb radiance = light_radiance_from(&lights[0], normal);
    for (int i = 0; i < 1000; i++) {
        float numbers[1][2] = {{random_unit(&random), random_unit(&random)}};
        struct light_sample sample, other;
        light_sample(&lights[0], &nowhere, &normal, (const float(*)[2])numbers, 1, &sample);
        float cosine = ps_dot(sample.direction, normal);
        assert_true(cosine > 0);
        expect_close(sample.weight.r * cosine, PI * radiance.r, 1e-4);
        expect_close(sample.pdf, cosine / PI, 1e-4);
        light_sample(&lights[1], &nowhere, &normal, (const float(*)[2])numbers, 1, &sample);
        bool lit = sample_light(&lights[1], nowhere, numbers[0][0], numbers[0][1], &other);
        assert_true(!lit ||
                    (sample.pdf == other.pdf && ps_same(sample.direction, other.direction)));
    }
    light_release(&lights[1]);
}

/* --- the picture's place --- */

static struct sky_picture compass(void)
{
    /* Columns towards +z and -x, -x and -z, -z and +x, +x and +z; the upper half is blue. */
    static const float rgb[8][3] = {{1, 0, 9}, {2, 0, 9}, {3, 0, 9}, {4, 0, 9},
                                    {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
    return (struct sky_picture){4, 2, rgb};
}

static void expect_seen(double rotate, ps_vec3 direction, double red)
{
    struct sky_picture picture = compass();
    struct light light = sky_of(&picture, rotate);
    ps_vec3 above = ps_normalize((ps_vec3){direction.x, 1, direction.z});
    ps_vec3 below = ps_normalize((ps_vec3){direction.x, -1, direction.z});
    ps_rgb high = light_radiance_from(&light, above), low = light_radiance_from(&light, below);
    expect_close(high.r, 2 * red, 1e-4);
    expect_close(low.r, 2 * red, 1e-4);
    expect_close(high.b, 0.5 * 9, 1e-4);
    assert_true(fabsf(low.b) < 1e-4f && high.g == 0);
    light_release(&light);
}

static void test_place_of_the_picture(void **state)
{
    (void)state;
    const float s = 0.70710678f;
    const ps_vec3 places[4] = {{-s, 0, s}, {-s, 0, -s}, {s, 0, -s}, {s, 0, s}};
    for (int i = 0; i < 4; i++) {
        expect_seen(0, places[i], i + 1);
        /* Counter-clockwise seen from above, -z goes to -x. */
        expect_seen(90, places[i], (i + 1) % 4 + 1);
        expect_seen(-90, places[i], (i + 3) % 4 + 1);
        expect_seen(360 + 180, places[i], (i + 2) % 4 + 1);
    }
    expect_seen(0, (ps_vec3){0, 0, -1}, 2.5); /* half way between pixels */
    expect_seen(0, (ps_vec3){0, 0, 1}, 2.5);  /* also where the picture closes: 4 and 1 */
    expect_seen(0, (ps_vec3){1, 0, 0}, 3.5);
    expect_seen(45, (ps_vec3){0, 0, -1}, 3);
}

/* --- irradiance and power --- */

static void test_even_sky(void **state)
{
    (void)state;
    struct light light = sky_of(NULL, 0);
    expect_close(irradiance_by_samples(&light, up, tilted), PI * 2, 1e-4);
    expect_close(light_power(&light).r, 4 * PI * 2 * PI * 25, 1e-6);
    expect_close(light_power(&light).b, 4 * PI * 0.5 * PI * 25, 1e-6);
    expect_flux_is_power(&light, 1e-5);
    assert_true(light_radiance_from(&light, tilted).g == 1);
    assert_false(light_is_delta(&light));
}

/* A picture of one colour is that colour, down to a single pixel. */
static void test_even_picture(void **state)
{
    (void)state;
    static float rgb[32 * 16][3];
    for (int i = 0; i < 32 * 16; i++)
        rgb[i][0] = rgb[i][1] = rgb[i][2] = 3;
    for (uint32_t size = 1; size <= 16; size += 15) {
        struct sky_picture picture = {2 * size, size, (const float(*)[3])rgb};
        struct light light = sky_of(&picture, 11);
        expect_close(light_power(&light).r, 4 * PI * 6 * PI * 25, 1e-5);
        expect_flux_is_power(&light, 1e-4);
        expect_close(irradiance_by_samples(&light, up, tilted), PI * 6, 1e-3);
        expect_close(light_pdf(&light, up, tilted, INFINITY, up), 1 / (4 * PI), 1e-5);
        light_release(&light);
    }
}

/* Radiance over the sphere by a grid of directions that knows nothing of the picture's. */
static double integrate(const struct light *light, const ps_vec3 *normal)
{
    enum { STEPS = 2000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            double x = 2 * (i + 0.5) / STEPS - 1, phi = 2 * PI * (k + 0.5) / STEPS;
            double sine = sqrt(1 - x * x);
            ps_vec3 direction = {(float)x, (float)(sine * cos(phi)), (float)(sine * sin(phi))};
            double weight = normal ? fmax(0, ps_dot(direction, *normal)) : 1;
            sum += weight * light_radiance_from(light, direction).r;
        }
    return sum * 4 * PI / STEPS / STEPS;
}

static void test_picture_against_quadrature(void **state)
{
    (void)state;
    struct sky_picture picture = spotted(0);
    struct light light = sky_of(&picture, 77);
    expect_close(light_power(&light).r, integrate(&light, NULL) * PI * 25, 1e-4);
    expect_flux_is_power(&light, 2e-2);
    expect_close(irradiance_by_samples(&light, up, up), integrate(&light, &up), 2e-3);
    expect_close(irradiance_by_samples(&light, up, tilted), integrate(&light, &tilted), 2e-3);
    light_release(&light);
}

static void test_photons_agree_with_samples(void **state)
{
    (void)state;
    struct sky_picture picture = spotted(0);
    struct light lights[] = {sky_of(NULL, 0), sky_of(&picture, 200)};
    for (size_t i = 0; i < 2; i++) {
        expect_plate_agrees(&lights[i], (ps_vec3){2, 1, 4}, (ps_vec3){0.6f, 0.8f, 0}, 1);
        light_release(&lights[i]);
    }
}

/* --- what is dark, and what is refused --- */

static void test_negative_and_black_pictures(void **state)
{
    (void)state;
    static const float rgb[2][3] = {{-1, 0, 0}, {0, -2, 0}};
    struct sky_picture picture = {2, 1, rgb};
    struct light light = sky_of(&picture, 0);
    struct light_sample sample;
    ps_ray ray;
    ps_vec3 normal;
    const float u[4] = {0.1f, 0.9f, 0.4f, 0.4f};
    assert_true(light_power(&light).r == 0 && light_power(&light).g == 0);
    assert_false(sample_light(&light, up, 0.2f, 0.4f, &sample));
    assert_true(light_emit(&light, u, &ray, &normal).r == 0);
    light_release(&light);
    light_release(&light);
}

static void expect_refused(const struct sky_picture *picture, enum light_unit unit)
{
    struct light light;
    struct error error = {""};
    const struct light_bounds bounds = {{0, 0, 0}, 1};
    const struct light_description description = {
        .kind = LIGHT_SKY, .amount = {1, 1, 1}, .unit = unit};
    assert_int_equal(light_create(&description, &bounds, picture, &light, &error),
                     PS_ERROR_INVALID);
    assert_true(error.text[0]);
}

static void test_refusals(void **state)
{
    (void)state;
    static const float rgb[3][3] = {{1, 1, 1}, {1, INFINITY, 1}, {1, 1, NAN}};
    static const float bright[2][3] = {{3e38f, 0, 0}, {3e38f, 0, 0}};
    expect_refused(&(struct sky_picture){2, 1, rgb}, UNIT_RADIANCE);
    expect_refused(&(struct sky_picture){1, 1, rgb + 2}, UNIT_RADIANCE);
    expect_refused(&(struct sky_picture){2, 1, bright}, UNIT_RADIANCE);
    expect_refused(&(struct sky_picture){0, 1, rgb}, UNIT_RADIANCE);
    expect_refused(NULL, UNIT_IRRADIANCE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_softness),
        cmocka_unit_test(test_directions_have_their_density),
        cmocka_unit_test(test_samples),
        cmocka_unit_test(test_density_of_samples_is_that_of_their_direction),
        cmocka_unit_test(test_by_the_cosine),
        cmocka_unit_test(test_place_of_the_picture),
        cmocka_unit_test(test_even_sky),
        cmocka_unit_test(test_even_picture),
        cmocka_unit_test(test_picture_against_quadrature),
        cmocka_unit_test(test_photons_agree_with_samples),
        cmocka_unit_test(test_negative_and_black_pictures),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
