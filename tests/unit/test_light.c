/* test_light.c: lights: what they emit in sum, their profile, and how a scene chooses among them.
 */
#include "scene/light.h"

#include "scene/scene.h"
#include "support/chi_squared.h"
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
    assert_int_equal(scene_create(&description, &scene, &error), PS_OK);
    return scene;
}

/* Each light is chosen as often as it says, and as often as `shares` wants. */
static void expect_shares(const float *intensities, const double *shares, size_t count)
{
    enum { STEPS = 10000 };
    struct scene scene = scene_with(intensities, count);
    double chosen[8] = {0}, said[8] = {0}, sum = 0;
    for (int i = 0; i < STEPS; i++) {
        float probability;
        size_t light = scene_choose_light(&scene, (i + 0.5f) / STEPS, &probability);
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
    float probability;
    assert_true(shares[scene_choose_light(&scene, 0, &probability)] > 0);
    assert_true(shares[scene_choose_light(&scene, 1 - 0x1p-24f, &probability)] > 0);
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
        cmocka_unit_test(test_choice_by_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
