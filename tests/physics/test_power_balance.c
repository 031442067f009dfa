/* test_power_balance.c: the power that a lamp sends out is what the walls around it absorb.
 *
 * A hollow sphere of radius R and albedo a holds a lamp of power P and an object, both of which
 * absorb nothing. In balance P = (1 - a) * integral of the irradiance E over the wall. From the
 * centre, whose camera does not see lamp and object, the wall has radiance a / pi E, and a piece of
 * it dA fills the solid angle dA / R^2, so that
 *
 *     integral of radiance over all directions = a P / (pi R^2 (1 - a))
 *
 * wherever lamp and object are and whatever the light does on its way. Six pictures of 90 degrees
 * show all directions; a pixel's solid angle goes with the cube of the cosine to its middle.
 */
#include "support/render_scene.h"
#include "support/statistics_of.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define PI 3.14159265358979323846
#define SEEDS 6
#define SIDE 12 /* pixels */
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

#define RADIUS 2.0
#define ALBEDO 0.5
#define LAMP_RADIUS 0.3

/* The lamp's power is 4 pi^2 times the square of its radius. */
static const char scene[] =
    "psd: 1\n"
    "camera: {location: [0, 0, 0], look_at: [%s], up: [%s], angle: 90}\n"
    "image: {width: 12, height: 12}\n"
    "materials:\n"
    "  wall: {diffuse: 0.5}\n"
    "  white: {diffuse: 1}\n"
    "  lamp: {mirror: 1, emission: 1}\n"
    "  polished: {mirror: 1}\n"
    "  brushed: {metal: {color: 1, roughness: 0.5}}\n"
    "  object: %s\n"
    "objects:\n"
    "  - sphere: {center: [0, 0, 0], radius: 2, material: wall}\n"
    "  - sphere: {center: [0.3, 1.2, 0], radius: 0.3, material: lamp, camera: no}\n"
    "  - %s\n"
    "render: {seed: %d, light_samples: 16}\n";

static const char ball[] =
    "sphere: {center: [-0.1, -0.3, 0.2], radius: 0.8, material: object, camera: no}";
static const char block[] = "box: {corners: [[-0.9, -0.5, -0.7], [0.7, 0.2, 0.9]],"
                            " rotate: [20, 0, 30], material: object, camera: no}";

/* Integral over the solid angle of one picture, a sixth of all. */
static double radiance_over(const struct image *image)
{
    double sum = 0, whole = 0;
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++) {
            double u = ((double)x + 0.5) * 2 / SIDE - 1, v = ((double)y + 0.5) * 2 / SIDE - 1;
            double solid_angle = pow(1 + u * u + v * v, -1.5);
            sum += solid_angle * mean_of(image, "G", x, y, 1, 1);
            whole += solid_angle;
        }
    return sum / whole * 4 * PI / 6;
}

static double radiance_all_around(const char *material, const char *object, int seed,
                                  const char *const choices[])
{
    static const char *const views[6][2] = {{"1, 0, 0", "0, 1, 0"}, {"-1, 0, 0", "0, 1, 0"},
                                            {"0, 1, 0", "1, 0, 0"}, {"0, -1, 0", "1, 0, 0"},
                                            {"0, 0, 1", "0, 1, 0"}, {"0, 0, -1", "0, 1, 0"}};
    double sum = 0;
    char text[2048];
    for (size_t i = 0; i < COUNT(views); i++) {
        snprintf(text, sizeof text, scene, views[i][0], views[i][1], material, object,
                 6 * seed + (int)i);
        struct rendering rendering = render_text(text, 2, choices);
        sum += radiance_over(&rendering.image);
        rendering_release(&rendering);
    }
    return sum;
}

struct method {
    const char *name;
    const char *choices[6];
    double bias;
};

static const struct method methods[] = {
    {"pathtrace", {"estimator=pathtrace:samples=64", "bounces=all", NULL}, 0},
    {"bdpt", {"estimator=bdpt:samples=16", "bounces=all", NULL}, 0.005},
    {"irradiance_cache", {"estimator=irradiance_cache:samples=256", "bounces=all", NULL}, 0.01},
    {"splat",
     {"estimator=splat", "injection=photon:count=4000", "bounces=all",
      "visibility=shadowmap:radius=0.06", NULL},
     0.02},
    {"photonmap",
     {"estimator=photonmap:neighbours=40", "injection=photon:count=4000", "bounces=all", NULL},
     0.01},
    {"final_gather",
     {"estimator=final_gather:samples=16", "injection=photon:count=4000", "bounces=all", NULL},
     0.02},
    {"gather",
     {"estimator=gather:samples=16", "injection=photon:count=4000", "bounces=all", NULL},
     0.01},
};

static void check(const char *material, const char *object)
{
    double power = 4 * PI * PI * LAMP_RADIUS * LAMP_RADIUS;
    double expected = ALBEDO * power / (PI * RADIUS * RADIUS * (1 - ALBEDO));
    for (size_t i = 0; i < COUNT(methods); i++) {
        double sums[SEEDS];
        char what[256];
        for (int seed = 0; seed < SEEDS; seed++)
            sums[seed] = radiance_all_around(material, object, seed, methods[i].choices);
        snprintf(what, sizeof what, "%s: %.3s %s", methods[i].name, object, material);
        expect_estimate(what, estimate_of(sums, SEEDS), expected, methods[i].bias);
    }
}

static void test_mirror(void **state)
{
    (void)state;
    check("{mirror: 1}", block);
}

static void test_rough_metal(void **state)
{
    (void)state;
    check("{metal: {color: 1, roughness: 0.4}}", ball);
}

static void test_gloss(void **state)
{
    (void)state;
    check("{glossy: {diffuse: 1, specular: 0.2, roughness: 0.4}}", block);
}

static void test_glass(void **state)
{
    (void)state;
    check("{dielectric: {ior: 1.5}}", ball);
}

static void test_mix(void **state)
{
    (void)state;
    check("{mix: [{material: white, weight: 0.4}, {material: polished, weight: 0.3},"
          " {material: brushed, weight: 0.3}]}",
          ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SLOW_TEST(test_mirror), cmocka_unit_test(test_rough_metal),
        SLOW_TEST(test_gloss),  SLOW_TEST(test_glass),
        SLOW_TEST(test_mix),
    };
    return RUN_TESTS(tests);
}
