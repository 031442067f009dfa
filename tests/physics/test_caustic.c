/* test_caustic.c: light that mirrors and glass throw on a floor.
 *
 * A plane mirror of reflectance k: what it throws on a floor point comes from the lamp's image
 * behind it, a sphere of radiance k L and radius r at distance d: E = pi k L (r / d)^2 cos(t),
 * while all of the image is seen in the mirror. A vertical mirror throws no light of the floor back
 * to it.
 *
 * A plate of glass under the sun: with reflectance R of one border (Fresnel) and A =
 * exp(-absorption * length of the way through) it lets through T = (1 - R)^2 A / (1 - R^2 A^2), all
 * reflections inside taken together. A sun of half angle s and irradiance 1 gives the mean of T
 * over its disc, weighed with the cosine.
 *
 * A glass ball: path tracing is the truth. The camera does not see what is above the floor.
 *
 * A room whose sun shines through a pane of glass has the light that photons bring.
 *
 * The focus of a glass ball is as bright with the automatic radius as with a tiny one and many
 * photons, and a denoiser leaves it so.
 *
 * A ceiling above a ball that stands in its own caustic, which rays reach through the ball alone:
 * its light is right, and without grain.
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
#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define SEEDS 4

struct method {
    const char *name;
    const char *choices[6];
    double bias;
};

/* Looks at the floor from -0.4 to 0.4 in x and z. */
#define CAMERA                                                                                     \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 0.1, 0], look_at: [0, 0, 0], up: [0, 0, -1],\n"                        \
    "         projection: orthographic, width: 0.8}\n"                                             \
    "image: {width: 16, height: 16}\n"

static void check(const char *name, const char *text, const struct method *methods, size_t count,
                  double expected)
{
    for (size_t i = 0; i < count; i++) {
        char what[128];
        snprintf(what, sizeof what, "%s: %s", name, methods[i].name);
        struct estimate estimate = estimate_channel(text, methods[i].choices, "indirect.G", SEEDS);
        expect_estimate(what, estimate, expected, methods[i].bias);
    }
}

/* --- mirror --------------------------------------------------------------------------------- */

#define MIRROR(LIGHT)                                                                              \
    CAMERA                                                                                         \
    "materials: {floor: {diffuse: 0.5}, mirror: {mirror: 0.8}}\n"                                  \
    "lights:\n"                                                                                    \
    "  - " LIGHT "\n"                                                                              \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: floor}\n"     \
    "  - quad: {corners: [[1, 0.2, -1], [1, 0.2, 1], [1, 1.8, 1], [1, 1.8, -1]],\n"                \
    "           material: mirror, camera: no}\n"                                                   \
    "render: {seed: %d}\n"

/* Mean of h / d^3 over the floor that is seen, for the image at (2, 2, 0). */
static double mean_from_image(void)
{
    double sum = 0;
    for (int i = 0; i < 100; i++)
        for (int k = 0; k < 100; k++) {
            double x = 2 - (0.008 * (i + 0.5) - 0.4), z = 0.008 * (k + 0.5) - 0.4;
            sum += 2 * pow(4 + x * x + z * z, -1.5);
        }
    return sum / 10000;
}

static const struct method mirror_methods[] = {
    {"gather",
     {"estimator=gather", "injection=photon:count=100000", "bounces=all",
      "visibility=shadowmap:radius=0.08", NULL},
     0.01},
    {"splat",
     {"estimator=splat", "injection=photon:count=100000", "bounces=all",
      "visibility=shadowmap:radius=0.08", NULL},
     0.01},
    {"bdpt", {"estimator=bdpt:samples=64", "bounces=all", NULL}, 0.002},
    {"photonmap",
     {"estimator=photonmap:neighbours=60", "injection=photon:count=100000", "bounces=all", NULL},
     0.01},
    {"pathtrace", {"estimator=pathtrace:samples=1024", "bounces=all", NULL}, 0},
    {"irradiance_cache",
     {"estimator=irradiance_cache:samples=512", "injection=photon:count=100000", "bounces=all",
      "visibility=shadowmap:radius=0.08", NULL},
     0.01},
    {"voxel_cone",
     {"estimator=voxel_cone", "injection=photon:count=100000", "bounces=all",
      "visibility=shadowmap:radius=0.08", NULL},
     0.06}, /* what the mirror gets from the floor leaves it in a wide lobe */
    {"final_gather",
     {"estimator=final_gather:samples=16", "injection=photon:count=100000", "bounces=all", NULL},
     0.015},
    {"photonmap, gather",
     {"estimator=photonmap:neighbours=60,gather=1024", "injection=photon:count=2000", "bounces=all",
      NULL},
     0.005},
};

static void test_mirror(void **state)
{
    (void)state;
    static const char lamp[] =
        MIRROR("sphere: {location: [0, 2, 0], radius: 0.3, radiance: 1, visible: no}");
    check("mirror, lamp", lamp, mirror_methods, COUNT(mirror_methods),
          0.5 * 0.8 * 0.09 * mean_from_image());
}

/* Only light paths find the way of a light without a size over a mirror. */
static void test_mirror_and_point_light(void **state)
{
    (void)state;
    static const char point[] = MIRROR("point: {location: [0, 2, 0], intensity: 1}");
    check("mirror, point light", point, mirror_methods, 3, 0.5 / PI * 0.8 * mean_from_image());
}

/* --- glass plate ---------------------------------------------------------------------------- */

#define HALF_ANGLE 20.0
#define IOR 1.5
#define THICKNESS 0.4
#define ABSORPTION 0.8

static const char plate[] = CAMERA
    "materials: {floor: {diffuse: 0.01}, glass: {dielectric: {ior: 1.5, absorption: 0.8}}}\n"
    "lights: [{sun: {direction: [0, -1, 0], angle: 40, irradiance: 100}}]\n"
    "objects:\n"
    "  - quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: floor}\n"
    "  - box: {corners: [[-1, 0.2, -1], [1, 0.6, 1]], material: glass, camera: no}\n"
    "render: {seed: %d}\n";

static double transmittance(double angle)
{
    double cosine = cos(angle), inner = sqrt(1 - pow(sin(angle) / IOR, 2));
    double parallel = (IOR * cosine - inner) / (IOR * cosine + inner);
    double perpendicular = (cosine - IOR * inner) / (cosine + IOR * inner);
    double r = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    double a = exp(-ABSORPTION * THICKNESS / inner);
    return (1 - r) * (1 - r) * a / (1 - r * r * a * a);
}

static double mean_transmittance(void)
{
    double sum = 0, whole = 0;
    for (int i = 0; i < 1000; i++) {
        double angle = HALF_ANGLE * PI / 180 * (i + 0.5) / 1000;
        sum += transmittance(angle) * cos(angle) * sin(angle);
        whole += cos(angle) * sin(angle);
    }
    return sum / whole;
}

static void test_absorbing_plate(void **state)
{
    (void)state;
    static const struct method methods[] = {
        {"splat",
         {"estimator=splat", "injection=photon:count=50000", "bounces=all",
          "visibility=shadowmap:radius=0.05", NULL},
         0.01},
        {"photonmap",
         {"estimator=photonmap:neighbours=60", "injection=photon:count=50000", "bounces=all", NULL},
         0.01},
        {"pathtrace", {"estimator=pathtrace:samples=512", "bounces=all", NULL}, 0.002},
        {"bdpt", {"estimator=bdpt:samples=64", "bounces=all", NULL}, 0.002},
    };
    check("glass plate", plate, methods, COUNT(methods), 0.01 / PI * 100 * mean_transmittance());
}

/* --- agreement ------------------------------------------------------------------------------ */

/* A lamp that shines on something, and a floor of which all that the caustic reaches is seen. */
#define LIT(OBJECT)                                                                                \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 0.1, 0], look_at: [0, 0, 0], up: [0, 0, -1],\n"                        \
    "         projection: orthographic, width: 2}\n"                                               \
    "image: {width: 24, height: 24}\n"                                                             \
    "materials:\n"                                                                                 \
    "  floor: {diffuse: 0.8}\n"                                                                    \
    "  glass: {dielectric: {ior: 1.5}}\n"                                                          \
    "  green: {dielectric: {ior: 1.5, absorption: 1}}\n"                                           \
    "  metal: {metal: {color: 0.9, roughness: 0.4}}\n"                                             \
    "lights:\n"                                                                                    \
    "  - rectangle: {corners: [[-0.5, 3, -0.5], [0.5, 3, -0.5], [0.5, 3, 0.5]], radiance: 1,\n"    \
    "                visible: no}\n"                                                               \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: floor}\n"     \
    "  - " OBJECT "\n"                                                                             \
    "render: {seed: %d}\n"

/* The nearest photons alone overrate a focus; a radius limits that. */
static const struct method agreeing[] = {
    {"gather",
     {"estimator=gather:samples=64", "injection=photon:count=200000", "bounces=all",
      "visibility=shadowmap:radius=0.05", NULL},
     0.01},
    {"splat",
     {"estimator=splat", "injection=photon:count=200000", "bounces=all",
      "visibility=shadowmap:radius=0.05", NULL},
     0.01},
    {"photonmap",
     {"estimator=photonmap:neighbours=500,max_radius=0.05,filter=box",
      "injection=photon:count=200000", "bounces=all", NULL},
     0.015},
    /* The mean over the pixels, where path tracing takes their middles: 1.7 % apart in the focus of
     * the ball. */
    {"bdpt", {"estimator=bdpt:samples=128", "bounces=all", NULL}, 0.02},
};

static void agree(const char *name, const char *text)
{
    static const char *const path_tracing[] = {"estimator=pathtrace:samples=2048", "bounces=all",
                                               NULL};
    struct estimate truth = estimate_channel(text, path_tracing, "indirect.G", SEEDS);
    for (size_t i = 0; i < COUNT(agreeing); i++) {
        char what[128];
        snprintf(what, sizeof what, "%s: %s", name, agreeing[i].name);
        expect_agreement(what, estimate_channel(text, agreeing[i].choices, "indirect.G", SEEDS),
                         truth, agreeing[i].bias);
    }
}

static void test_glass_ball(void **state)
{
    (void)state;
    agree("glass ball",
          LIT("sphere: {center: [0, 0.8, 0], radius: 0.5, material: glass, camera: no}"));
    agree("glass ball that absorbs",
          LIT("sphere: {center: [0, 0.8, 0], radius: 0.5, material: green, camera: no}"));
}

static void test_metal_ring(void **state)
{
    (void)state;
    agree("metal ring", LIT("cylinder: {from: [0, 0, 0], to: [0, 0.4, 0], radius: 1.5, open: yes,"
                            " material: metal, camera: no}"));
}

/* --- focus ---------------------------------------------------------------------------------- */

/* A ball of radius R and n = 1.5 has its focus 1.5 R from its centre. The scene is large, as rooms
 * are. */
static const char focus[] =
    "psd: 1\n"
    "camera: {location: [0, 0.1, 0], look_at: [0, 0, 0], up: [0, 0, -1],\n"
    "         projection: orthographic, width: 1.2}\n"
    "image: {width: 48, height: 48}\n"
    "materials: {floor: {diffuse: 0.8}, glass: {dielectric: {ior: 1.5}}}\n"
    "lights: [{sphere: {location: [0, 6, 0], radius: 0.2, power: 100}}]\n"
    "objects:\n"
    "  - quad: {corners: [[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], material: floor}\n"
    "  - sphere: {center: [0, 0.75, 0], radius: 0.5, material: glass}\n"
    "render: {seed: 7, passes: %d, aa_samples: 1}\n";

static double light_at_focus(int passes, const char *estimator, const char *injection,
                             const char *visibility, const char *denoiser)
{
    const char *const choices[] = {estimator, injection, visibility, denoiser, "bounces=1", NULL};
    char text[2048];
    snprintf(text, sizeof text, focus, passes);
    struct rendering rendering = render_text(text, 2, choices);
    double light = mean_of(&rendering.image, "indirect.G", 22, 22, 4, 4);
    rendering_release(&rendering);
    return light;
}

static void test_focus(void **state)
{
    (void)state;
    double sharp = light_at_focus(4, "estimator=splat", "injection=photon:count=1000000",
                                  "visibility=raycast:radius=0.01", "denoiser=none");
    static const char *const estimators[] = {"estimator=gather:samples=1", "estimator=splat",
                                             "estimator=irradiance_cache:samples=16"};
    for (size_t i = 0; i < COUNT(estimators); i++) {
        double light = light_at_focus(4, estimators[i], "injection=photon:count=50000",
                                      "visibility=shadowmap", "denoiser=none");
        print_message("%s: %.3f of the light at the focus\n", estimators[i], light / sharp);
        assert_true(light > 0.8 * sharp && light < 1.2 * sharp);
    }
}

/* Light of splats is smooth, and passes by denoisers where estimators find the rest by rays. */
static void test_focus_behind_a_denoiser(void **state)
{
    (void)state;
    static const char *const denoisers[] = {"denoiser=regression", "denoiser=gaussian"};
    double sharp = light_at_focus(1, "estimator=gather", "injection=photon:count=50000",
                                  "visibility=shadowmap", "denoiser=none");
    for (size_t i = 0; i < COUNT(denoisers); i++) {
        double light = light_at_focus(1, "estimator=gather", "injection=photon:count=50000",
                                      "visibility=shadowmap", denoisers[i]);
        print_message("%s: %.3f of the light at the focus\n", denoisers[i], light / sharp);
        assert_true(fabs(light / sharp - 1) < 0.02);
    }
}

/* --- window --------------------------------------------------------------------------------- */

/* A room that gets all of its light through a pane of glass: the sky's, and that of a sun, which
 * paths find by chance. */
static const char window[] =
    "psd: 1\n"
    "camera: {location: [0.2, 1.5, 2.7], look_at: [0, 1.1, -2], angle: 65}\n"
    "image: {width: 32, height: 24}\n"
    "materials: {wall: {diffuse: 0.7}, glass: {dielectric: {ior: 1.5}}}\n"
    "lights:\n"
    "  - sun: {direction: [0.8, -0.7, -0.3], irradiance: 3, angle: 0.5}\n"
    "  - sky: {radiance: 0.3}\n"
    "objects:\n"
    "  - quad: {material: wall, corners: [[-2, 0, 3], [2, 0, 3], [2, 0, -3], [-2, 0, -3]]}\n"
    "  - quad: {material: wall, corners: [[-2, 2.6, 3], [-2, 2.6, -3], [2, 2.6, -3], [2, 2.6, "
    "3]]}\n"
    "  - quad: {material: wall, corners: [[-2, 0, -3], [2, 0, -3], [2, 2.6, -3], [-2, 2.6, -3]]}\n"
    "  - quad: {material: wall, corners: [[-2, 0, 3], [-2, 2.6, 3], [2, 2.6, 3], [2, 0, 3]]}\n"
    "  - quad: {material: wall, corners: [[2, 0, 3], [2, 2.6, 3], [2, 2.6, -3], [2, 0, -3]]}\n"
    "  - quad: {material: wall, corners: [[-2, 0, 3], [-2, 0, -3], [-2, 0.8, -3], [-2, 0.8, 3]]}\n"
    "  - quad: {material: wall, corners: [[-2, 2.2, 3], [-2, 2.2, -3], [-2, 2.6, -3], [-2, 2.6, "
    "3]]}\n"
    "  - quad: {material: wall, corners: [[-2, 0.8, 3], [-2, 0.8, 1], [-2, 2.2, 1], [-2, 2.2, "
    "3]]}\n"
    "  - quad: {material: wall, corners: [[-2, 0.8, -1], [-2, 0.8, -3], [-2, 2.2, -3], [-2, 2.2, "
    "-1]]}\n"
    "  - box: {corners: [[-2.02, 0.8, -1], [-2.0, 2.2, 1]], material: glass}\n"
    "render: {seed: %d, passes: 2, aa_samples: 1}\n";

/* That of photons alone is the truth: single passes have neither too little of the sun nor, seldom,
 * far too much. */
static void test_window(void **state)
{
    (void)state;
    static const char *const photons[] = {"estimator=splat", "injection=photon:count=100000",
                                          "bounces=all", NULL};
    static const char *const gather[] = {"estimator=gather", "injection=photon:count=100000",
                                         "bounces=all", NULL};
    struct estimate expected = estimate_channel(window, photons, "indirect.G", SEEDS);
    struct estimate estimate = estimate_channel(window, gather, "indirect.G", SEEDS);
    expect_agreement("sunlit window, gather / splat", estimate, expected, 0.03);
}

/* --- ceiling -------------------------------------------------------------------------------- */

static const char ceiling[] =
    "psd: 1\n"
    "camera: {location: [0, 1.9, 0], look_at: [0, 2, 0], up: [0, 0, -1],\n"
    "         projection: orthographic, width: 2}\n"
    "image: {width: 64, height: 64}\n"
    "materials: {wall: {diffuse: 0.6}, glass: {dielectric: {ior: 1.5}}}\n"
    "lights: [{rectangle: {corners: [[-0.2, 1.95, -0.2], [0.2, 1.95, -0.2], [0.2, 1.95, 0.2]],\n"
    "                      radiance: 10, visible: no}}]\n"
    "objects:\n"
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: wall}\n"
    "  - quad: {corners: [[-2, 2, 2], [-2, 2, -2], [2, 2, -2], [2, 2, 2]], material: wall}\n"
    "  - sphere: {center: [0, 0.5, 0], radius: 0.5, material: glass, camera: no}\n"
    "render: {seed: %d, passes: 1, aa_samples: 1}\n";

static void test_ceiling(void **state)
{
    (void)state;
    static const char *const gather[] = {"estimator=gather:samples=16,surfels=256", "bounces=all",
                                         NULL};
    static const char *const truth[] = {"estimator=bdpt:samples=32", "bounces=all", NULL};
    double expected = estimate_channel(ceiling, truth, "indirect.G", 2).mean, mean = 0, most = 0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        char text[2048];
        snprintf(text, sizeof text, ceiling, seed);
        struct rendering rendering = render_text(text, 2, gather);
        const float *light = image_channel(&rendering.image, "indirect.G");
        mean += mean_of_all(&rendering.image, "indirect.G") / SEEDS;
        for (size_t i = 0; i < (size_t)rendering.image.width * rendering.image.height; i++)
            most = fmax(most, light[i]);
        rendering_release(&rendering);
    }
    print_message("ceiling: %.3f of the light, %.1f times in the brightest pixel\n",
                  mean / expected, most / expected);
    assert_true(fabs(mean / expected - 1) < 0.03);
    assert_true(most < 8 * expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_window),
        cmocka_unit_test(test_focus),
        cmocka_unit_test(test_focus_behind_a_denoiser),
        cmocka_unit_test(test_ceiling),
        SLOW_TEST(test_mirror),
        cmocka_unit_test(test_mirror_and_point_light),
        cmocka_unit_test(test_absorbing_plate),
        SLOW_TEST(test_glass_ball),
        SLOW_TEST(test_metal_ring),
    };
    return RUN_TESTS(tests);
}
