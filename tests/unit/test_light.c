/* test_light.c: points and spots: what they emit in sum, their profile, and how a scene chooses
 * among lights. */
#include "scene/light.h"

#include "scene/scene.h"
#include "support/chi_squared.h"
#include "support/light_check.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

static const struct light_bounds no_bounds = {{0, 0, 0}, 0};

static struct light create(const struct light_description *description)
{
    struct light light;
    struct error error;
    assert_int_equal(light_create(description, &no_bounds, NULL, &light, &error), PS_OK);
    return light;
}

/* A ray by the two numbers that choose its direction, and its flux. */
static ps_rgb emit(const struct light *light, float u1, float u2, ps_ray *ray)
{
    const float u[4] = {u1, u2, 0.5f, 0.5f};
    ps_vec3 normal;
    ps_rgb flux = light_emit(light, u, ray, &normal);
    assert_true(normal.x == 0 && normal.y == 0 && normal.z == 0);
    return flux;
}

static struct light spot(double radius, double falloff)
{
    const struct light_description description = {
        .kind = LIGHT_SPOT,
        .location = {1, 2, 3},
        .point_at = {1, 0, 3},
        .amount = {4, 2, 1},
        .radius = radius,
        .falloff = falloff,
    };
    return create(&description);
}

static struct light point(void)
{
    const struct light_description description = {
        .kind = LIGHT_POINT, .location = {1, 2, 3}, .amount = {4, 2, 1}};
    return create(&description);
}

static void expect_near(double value, double expected)
{
    if (fabs(value - expected) > 1e-4 * fmax(fabs(expected), 1e-2))
        fail_msg("%.8g, expected %.8g", value, expected);
}

/* Intensity (red, full: 4) at an angle from the axis (0, -1, 0). */
static double at(const struct light *light, double degrees)
{
    double angle = degrees * PI / 180;
    ps_vec3 direction = {(float)(sin(angle) * 0.6), (float)-cos(angle), (float)(sin(angle) * 0.8)};
    ps_rgb intensity = light_intensity(light, direction);
    assert_true(fabsf(intensity.r - 2 * intensity.g) < 1e-6f);
    assert_true(fabsf(intensity.r - 4 * intensity.b) < 1e-6f);
    return intensity.r;
}

static void test_falloff(void **state)
{
    (void)state;
    struct light light = spot(20, 50);
    expect_near(at(&light, 0), 4);
    expect_near(at(&light, 19.9), 4);
    assert_true(at(&light, 50.1) == 0 && at(&light, 90) == 0 && at(&light, 180) == 0);
    double inner = cos(20 * PI / 180), outer = cos(50 * PI / 180), before = 4;
    for (double degrees = 20; degrees <= 50; degrees += 0.5) {
        double t = (cos(degrees * PI / 180) - outer) / (inner - outer);
        double value = at(&light, degrees);
        assert_true(fabs(value - 4 * t * t * (3 - 2 * t)) < 1e-4);
        assert_true(value <= before + 1e-5);
        before = value;
    }
    expect_near(at(&light, acos(0.5 * (inner + outer)) * 180 / PI), 2); /* half way: half */
}

static void test_hard_edge(void **state)
{
    (void)state;
    struct light light = spot(60, 60);
    expect_near(at(&light, 59.9), 4);
    assert_true(at(&light, 60.1) == 0);
    light = spot(90, 90); /* half of all space */
    expect_near(at(&light, 89.9), 4);
    assert_true(at(&light, 90.1) == 0);
}

static void test_point_shines_everywhere(void **state)
{
    (void)state;
    struct light light = point();
    for (double degrees = 0; degrees <= 180; degrees += 15)
        expect_near(at(&light, degrees), 4);
    /* Nor does rounding make a dark spot at a pole. */
    struct random random = {13};
    for (int i = 0; i < 10000; i++) {
        float tilt = 1e-3f * random_unit(&random), pole = i % 2 ? 1.0f : -1.0f;
        ps_vec3 w = {tilt, -tilt, pole * random_between(&random, 0.1f, 3.0f)};
        assert_true(light_intensity(&light, ps_normalize(w)).r == 4);
    }
}

/* Flux that leaves the light by numerical integration of its intensity over directions. */
static double integrate(const struct light *light)
{
    enum { STEPS = 20000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        double cosine = 1 - 2 * (i + 0.5) / STEPS;
        sum += at(light, acos(cosine) * 180 / PI) * 2 / STEPS;
    }
    return 2 * PI * sum;
}

static double emitted(const struct light *light)
{
    enum { STEPS = 256 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            ps_ray ray;
            sum += emit(light, (i + 0.5f) / STEPS, (k + 0.5f) / STEPS, &ray).r;
            assert_true(ray.origin.x == 1 && ray.origin.y == 2 && ray.origin.z == 3);
            assert_true(ray.tnear == 0 && isinf(ray.tfar));
        }
    return sum / (STEPS * STEPS);
}

static void test_emission_sums_to_the_power(void **state)
{
    (void)state;
    static const double angles[][2] = {{30, 45}, {60, 60}, {1, 90}, {5, 6}, {90, 90}, {0.1, 30}};
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++) {
        struct light light = spot(angles[i][0], angles[i][1]);
        ps_rgb power = light_power(&light);
        assert_true(fabs(emitted(&light) / power.r - 1) < 1e-3);
        assert_true(fabs(integrate(&light) / power.r - 1) < 1e-2);
        expect_near(power.g, power.r / 2);
        expect_near(power.b, power.r / 4);
    }
    struct light hard = spot(60, 60);
    expect_near(light_power(&hard).r, 2 * PI * (1 - 0.5) * 4);
    struct light all = point();
    expect_near(light_power(&all).r, 4 * PI * 4);
    expect_near(emitted(&all), 4 * PI * 4);
    expect_near(integrate(&all), 4 * PI * 4);
}

/* Rays are even over the cone: their flux, not their number, makes the falloff. */
static void test_emission_is_even_over_the_cone(void **state)
{
    (void)state;
    enum { RAYS = 20000, RINGS = 20 };
    struct light light = spot(10, 70);
    double observed[RINGS] = {0}, expected[RINGS], limit = cos(70 * PI / 180);
    struct random random = {12};
    for (int i = 0; i < RAYS; i++) {
        ps_ray ray;
        float u1 = random_unit(&random), u2 = random_unit(&random);
        emit(&light, u1, u2, &ray);
        double height = (-ray.direction.y - limit) / (1 - limit);
        assert_true(height > -1e-5 && height < 1.00001);
        observed[(int)fmin(fmax(height, 0) * RINGS, RINGS - 1)]++;
    }
    for (int i = 0; i < RINGS; i++)
        expected[i] = (double)RAYS / RINGS;
    assert_true(chi_squared_probability(observed, expected, RINGS) > 1e-4);
}

static void test_aims_at_its_point(void **state)
{
    (void)state;
    struct light_description description = {.kind = LIGHT_SPOT,
                                            .location = {1, 1, 1},
                                            .point_at = {3, 7, -2},
                                            .amount = {1, 1, 1},
                                            .radius = 1,
                                            .falloff = 2};
    struct light light = create(&description);
    ps_ray ray;
    emit(&light, 0.0f, 0.0f, &ray); /* the middle of the cone */
    expect_near(ray.direction.x, 2.0 / 7);
    expect_near(ray.direction.y, 6.0 / 7);
    expect_near(ray.direction.z, -3.0 / 7);
}

/* Golden pictures hang on these numbers. */
static void test_emission_is_that_of_the_cone_bit_for_bit(void **state)
{
    (void)state;
    struct light lights[] = {spot(20, 50), spot(60, 60), point()};
    struct random random = {14};
    for (int i = 0; i < 3000; i++) {
        const struct light *light = &lights[i % 3];
        ps_ray ray;
        float u1 = random_unit(&random), u2 = random_unit(&random);
        ps_rgb flux = emit(light, u1, u2, &ray);
        float limit = light->spot.cos_falloff, solid_angle = 2.0f * PS_PI * (1.0f - limit);
        ps_vec3 direction = ps_cone_direction(light->spot.axis, limit, u1, u2);
        ps_rgb expected = ps_rgb_scale(light_intensity(light, direction), solid_angle);
        assert_memory_equal(&ray.direction, &direction, sizeof direction);
        assert_memory_equal(&flux, &expected, sizeof flux);
    }
}

static void test_samples(void **state)
{
    (void)state;
    struct light lights[] = {spot(20, 50), point()};
    struct random random = {15};
    int lit = 0;
    for (int i = 0; i < 10000; i++) {
        const struct light *light = &lights[i % 2];
        struct light_sample sample;
        ps_vec3 from = random_direction(&random); /* from the light */
        float distance = random_between(&random, 0.1f, 9);
        ps_vec3 position = ps_add_scaled((ps_vec3){1, 2, 3}, distance, from);
        ps_rgb intensity = light_intensity(light, from);
        assert_true(light_is_delta(light));
        assert_true(light_pdf(light, position, ps_scale(from, -1), distance, from) == 0);
        if (!sample_light(light, position, 0.3f, 0.7f, &sample)) {
            assert_true(intensity.r < 1e-3f);
            continue;
        }
        lit++;
        expect_close(sample.distance, distance, 1e-4);
        assert_true(ps_dot(sample.direction, from) < -0.99999f);
        assert_true(sample.pdf == 0);
        assert_true(fabs(sample.weight.r * distance * distance - intensity.r) < 2e-3);
        assert_true(sample.weight.r == 4 * sample.weight.b);
    }
    assert_true(lit > 5000 && lit < 9000);
    struct light_sample sample;
    assert_false(sample_light(&lights[0], (ps_vec3){1, 9, 3}, 0, 0, &sample)); /* behind it */
    assert_false(sample_light(&lights[1], (ps_vec3){1, 2, 3}, 0, 0, &sample)); /* at it */
}

/* --- tightness, power --- */

static struct light tight(double radius, double falloff, double tightness, enum light_unit unit)
{
    const struct light_description description = {.kind = LIGHT_SPOT,
                                                  .location = {1, 2, 3},
                                                  .point_at = {1, 0, 3},
                                                  .amount = {4, 2, 1},
                                                  .unit = unit,
                                                  .radius = radius,
                                                  .falloff = falloff,
                                                  .tightness = tightness};
    return create(&description);
}

static const double tight_spots[][3] = {{30, 45, 1},   {20, 60, 10},  {90, 90, 100},
                                        {0.1, 90, 10}, {1, 89, 1000}, {10, 10, 0.5}};
#define TIGHT_SPOTS (sizeof tight_spots / sizeof tight_spots[0])

static void test_tightness_is_a_power_of_the_cosine(void **state)
{
    (void)state;
    for (size_t i = 0; i < TIGHT_SPOTS; i++) {
        const double *angles = tight_spots[i];
        struct light light = tight(angles[0], angles[1], angles[2], UNIT_INTENSITY);
        struct light plain = tight(angles[0], angles[1], 0, UNIT_INTENSITY);
        for (double degrees = 0; degrees < 180; degrees += 0.7) {
            double factor = pow(fmax(0, cos(degrees * PI / 180)), angles[2]);
            assert_true(fabs(at(&light, degrees) - factor * at(&plain, degrees)) < 1e-3);
        }
    }
}

static void test_tight_emission_sums_to_the_power(void **state)
{
    (void)state;
    for (size_t i = 0; i < TIGHT_SPOTS; i++) {
        const double *angles = tight_spots[i];
        struct light light = tight(angles[0], angles[1], angles[2], UNIT_INTENSITY);
        double power = light_power(&light).r;
        expect_close(integrate(&light), power, 1e-2);
        expect_close(emitted(&light), power, 2e-3);
    }
    /* All of the half space: 2 pi I / (t + 1). */
    struct light all = tight(90, 90, 3, UNIT_INTENSITY);
    expect_near(light_power(&all).r, 2 * PI * 4 / 4);
}

/* Rays of a tight spot carry the edge alone; their number follows cos^t. */
static void test_tight_emission_follows_the_cosine(void **state)
{
    (void)state;
    enum { RAYS = 100000, RINGS = 20 };
    struct light light = tight(40, 40, 20, UNIT_INTENSITY);
    double observed[RINGS] = {0}, expected[RINGS], all = 1 - pow(cos(40 * PI / 180), 21);
    double flux = light_power(&light).r;
    struct random random = {16};
    for (int i = 0; i < RAYS; i++) {
        ps_ray ray;
        float u1 = random_unit(&random), u2 = random_unit(&random);
        expect_close(emit(&light, u1, u2, &ray).r, flux, 1e-4);
        double share = (1 - pow(-(double)ray.direction.y, 21)) / all;
        assert_true(share > -1e-5 && share < 1.0001);
        observed[(int)fmin(fmax(share, 0) * RINGS, RINGS - 1)]++;
    }
    for (int i = 0; i < RINGS; i++)
        expected[i] = (double)RAYS / RINGS;
    assert_true(chi_squared_probability(observed, expected, RINGS) > 1e-4);
}

static void test_power_as_unit(void **state)
{
    (void)state;
    for (size_t i = 0; i < TIGHT_SPOTS; i++)
        for (int is_tight = 0; is_tight < 2; is_tight++) {
            const double *angles = tight_spots[i];
            struct light light = tight(angles[0], angles[1], is_tight ? angles[2] : 0, UNIT_POWER);
            ps_rgb power = light_power(&light);
            expect_close(power.r, 4, 1e-5);
            expect_close(power.g, 2, 1e-5);
            expect_close(power.b, 1, 1e-5);
        }
    const struct light_description description = {
        .kind = LIGHT_POINT, .unit = UNIT_POWER, .amount = {12, 6, 3}};
    struct light light = create(&description);
    expect_near(light_intensity(&light, (ps_vec3){0, 1, 0}).r, 12 / (4 * PI));
}

static void test_photons_agree_with_samples(void **state)
{
    (void)state;
    struct light lights[] = {spot(20, 50), tight(5, 60, 4, UNIT_INTENSITY), point()};
    for (size_t i = 0; i < 3; i++)
        expect_plate_agrees(&lights[i], (ps_vec3){1.3f, 0.5f, 2.8f}, (ps_vec3){0, 0.8f, 0.6f}, 0.3);
}

static void expect_refused(const struct light_description *description)
{
    struct light light;
    struct error error = {""};
    assert_int_equal(light_create(description, &no_bounds, NULL, &light, &error), PS_ERROR_INVALID);
    assert_true(error.text[0]);
}

static void test_refusals(void **state)
{
    (void)state;
    struct light_description description = {.kind = LIGHT_POINT, .unit = UNIT_RADIANCE};
    expect_refused(&description);
    description = (struct light_description){.kind = LIGHT_SPOT, .radius = 10, .falloff = 20};
    expect_refused(&description); /* aimed at itself */
    description.point_at.x = 1;
    create(&description);
    description.radius = description.falloff = 1e-6; /* the cosine is 1 */
    create(&description);
    description.unit = UNIT_POWER;
    expect_refused(&description);
    description = (struct light_description){.kind = LIGHT_SPHERE, .unit = UNIT_RADIANCE};
    expect_refused(&description); /* a surface */
}

/* --- choosing among the lights of a scene --- */

static struct scene scene_with(const float *intensities, size_t count)
{
    struct light_description lights[8] = {{.kind = LIGHT_POINT}};
    struct camera_description camera = {.look_at = {0, 0, -1}, .up = {0, 1, 0}, .angle = 60};
    struct scene_description description = {
        .cameras = &camera,
        .camera_count = 1,
        .image = {.width = 4, .height = 4},
        .lights = lights,
        .light_count = count,
    };
    struct scene scene;
    struct error error;
    for (size_t i = 0; i < count; i++)
        lights[i] = (struct light_description){.kind = LIGHT_POINT,
                                               .amount = {intensities[i], 0, 2 * intensities[i]}};
    assert_int_equal(scene_create(&description, &scene, NULL, &error), PS_OK);
    return scene;
}

/* Each light is chosen as often as it says, and as often as `shares` wants. */
static void expect_shares(const float *intensities, const double *shares, size_t count)
{
    enum { STEPS = 10000 };
    struct scene scene = scene_with(intensities, count);
    double chosen[8] = {0}, said[8] = {0}, sum = 0;
    for (int i = 0; i < STEPS; i++) {
        float probability, number = (i + 0.5f) / STEPS;
        size_t light = scene_choose_light(&scene, &number, &probability);
        assert_true(number >= 0 && number < 1);
        assert_true(light < count && probability > 0);
        chosen[light] += 1.0 / STEPS;
        said[light] = probability;
    }
    for (size_t i = 0; i < count; i++) {
        assert_true(fabs(chosen[i] - shares[i]) < 2.0 / STEPS);
        assert_true(fabs(said[i] - shares[i]) < 1e-6);
        sum += said[i];
    }
    assert_true(fabs(sum - 1) < 1e-6);
    float probability, least = 0, most = 1 - 0x1p-24f;
    assert_true(shares[scene_choose_light(&scene, &least, &probability)] > 0);
    assert_true(shares[scene_choose_light(&scene, &most, &probability)] > 0);
    scene_release(&scene);
}

static void test_choice_by_power(void **state)
{
    (void)state;
    expect_shares((float[]){5}, (double[]){1}, 1);
    expect_shares((float[]){1, 2, 5}, (double[]){0.125, 0.25, 0.625}, 3);
    expect_shares((float[]){0, 1, 3, 0}, (double[]){0, 0.25, 0.75, 0}, 4);
    expect_shares((float[]){0, 0, 0, 0}, (double[]){0.25, 0.25, 0.25, 0.25}, 4);
    expect_shares((float[]){1e-8f, 1e-8f}, (double[]){0.5, 0.5}, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_falloff),
        cmocka_unit_test(test_hard_edge),
        cmocka_unit_test(test_point_shines_everywhere),
        cmocka_unit_test(test_emission_sums_to_the_power),
        cmocka_unit_test(test_emission_is_even_over_the_cone),
        cmocka_unit_test(test_aims_at_its_point),
        cmocka_unit_test(test_emission_is_that_of_the_cone_bit_for_bit),
        cmocka_unit_test(test_samples),
        cmocka_unit_test(test_tightness_is_a_power_of_the_cosine),
        cmocka_unit_test(test_tight_emission_sums_to_the_power),
        cmocka_unit_test(test_tight_emission_follows_the_cosine),
        cmocka_unit_test(test_power_as_unit),
        cmocka_unit_test(test_photons_agree_with_samples),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_choice_by_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
