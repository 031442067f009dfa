/* test_estimators.c: every estimator against closed forms.
 *
 * The mean (bias) is tested apart from noise: several seeds give the mean and its standard error;
 * the mean may be off by four of these plus the bias that the method has at these settings (0 for
 * path tracing).
 */
#include "support/statistics_of.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define PI 3.14159265358979323846
#define SEEDS 6

struct method {
    const char *name;
    const char *choices[5];
    double bias;
};

/* A lamp at the centre of a diffuse sphere of albedo a (see test_furnace.c): n bounces give the
 * radiance a / pi * (a + ... + a^n), all of them a / pi * a / (1 - a), for a lamp that gives
 * irradiance 1. */
static const char furnace[] =
    "psd: 1\n"
    "camera: {location: [0, 0, 0], look_at: [1, 0.3, 0.2], angle: 90}\n"
    "image: {width: 32, height: 32}\n"
    "materials: {wall: {diffuse: 0.6}}\n"
    "lights: [{point: {location: [0, 0, 0], intensity: 4}}]\n"
    "objects: [{sphere: {center: [0, 0, 0], radius: 2, material: wall}}]\n"
    "render: {seed: %d}\n";

static const struct method in_furnace[] = {
    {"pathtrace", {"estimator=pathtrace:samples=8", NULL}, 0},
    {"bdpt", {"estimator=bdpt:samples=8", NULL}, 0.002},
    {"splat",
     {"estimator=splat", "injection=photon:count=40000",
      "visibility=shadowmap:radius=0.06,step_back=auto", NULL},
     0.025},
    {"photonmap",
     {"estimator=photonmap:neighbours=50", "injection=photon:count=40000", NULL},
     0.015},
    {"photonmap, final gather",
     {"estimator=photonmap:neighbours=50,gather=2", "injection=photon:count=40000", NULL},
     0.015},
    {"vpl", {"estimator=vpl:lights=2000,clamp=0", "injection=photon:count=800", NULL}, 0.002},
    {"lightcuts", {"estimator=lightcuts:clamp=0", "injection=photon:count=2000", NULL}, 0.004},
    {"gather", {"estimator=gather:samples=8", "injection=photon:count=5000", NULL}, 0.003},
    {"irradiance_cache", {"estimator=irradiance_cache:samples=64", NULL}, 0.001},
    {"voxel_cone", {"estimator=voxel_cone:resolution=64", NULL}, 0.04},
    {"lpv",
     {"estimator=lpv", NULL},
     0.4}, /* light goes astray between cells, and walls at slopes keep it */
    {"radiosity", {"estimator=radiosity:samples=4,epsilon=2e-3", NULL}, 0.01},
    {"radiosity, elements",
     {"estimator=radiosity:reconstruction=elements,epsilon=2e-3", NULL},
     0.001},
};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static void check(const char *scene_name, const char *scene, const struct method *methods,
                  size_t count, double expected)
{
    for (size_t i = 0; i < count; i++) {
        char what[128];
        snprintf(what, sizeof what, "%s: %s", scene_name, methods[i].name);
        struct estimate estimate = estimate_channel(scene, methods[i].choices, "indirect.G", SEEDS);
        expect_estimate(what, estimate, expected, methods[i].bias);
    }
}

/* One key says for all of them how many bounces there are. */
static void test_furnace(void **state)
{
    (void)state;
    static const struct {
        const char *bounces;
        double irradiance; /* indirect, for albedo 0.6 */
    } cases[] = {{"1", 0.6}, {"2", 0.6 + 0.36}, {"all", 0.6 / 0.4}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        char scene[1024], name[64];
        snprintf(scene, sizeof scene, "%.*s, bounces: %s}\n", (int)(strlen(furnace) - 2), furnace,
                 cases[i].bounces);
        snprintf(name, sizeof name, "furnace, bounces: %s", cases[i].bounces);
        check(name, scene, in_furnace, COUNT(in_furnace), 0.6 / PI * cases[i].irradiance);
    }
}

/* As large as scenes may be: nothing that is summed or squared on the way overflows. */
static void test_large_furnace(void **state)
{
    (void)state;
    static const char large[] =
        "psd: 1\n"
        "camera: {location: [0, 0, 0], look_at: [1, 0.3, 0.2], angle: 90}\n"
        "image: {width: 32, height: 32}\n"
        "materials: {wall: {diffuse: 0.6}}\n"
        "lights: [{point: {location: [0, 0, 0], intensity: 9e16}}]\n"
        "objects: [{sphere: {center: [0, 0, 0], radius: 3e8, material: wall}}]\n"
        "render: {seed: %d, bounces: 2}\n";
    static const struct method methods[] = {
        {"pathtrace", {"estimator=pathtrace:samples=8", NULL}, 0},
        {"bdpt", {"estimator=bdpt:samples=8", NULL}, 0.002},
        {"irradiance_cache", {"estimator=irradiance_cache:samples=64", NULL}, 0.001},
        {"voxel_cone", {"estimator=voxel_cone:resolution=64", NULL}, 0.04},
        {"lpv", {"estimator=lpv", NULL}, 0.4},
        {"radiosity", {"estimator=radiosity:samples=4,epsilon=2e-3", NULL}, 0.01},
    };
    check("large furnace", large, methods, COUNT(methods), 0.6 / PI * (0.6 + 0.36));
}

/* A spotlight of half angle 3 degrees lights a small disc of albedo 0.8 on the floor from 1 above;
 * a receiver of albedo 0.5 hangs 2 above it, level or tilted by 60 degrees. A disc of radius p with
 * radiant exitance M gives a parallel element on its axis M p^2 / (d^2 + p^2), and an element
 * tilted by t cos(t) times that (p << d). */
#define PATCH                                                                                      \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0.6, 1.2, 0], look_at: [0, 2, 0], angle: 1}\n"                            \
    "image: {width: 16, height: 16}\n"                                                             \
    "materials: {floor: {diffuse: 0.8}, receiver: {diffuse: 0.5}}\n"                               \
    "lights: [{spotlight: {location: [0, 1, 0], point_at: [0, 0, 0], radius: 3, falloff: 3,\n"     \
    "                      intensity: 100}}]\n"                                                    \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], material: floor}\n"     \
    "  - quad: {corners: [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], material: receiver,\n"  \
    "           rotate: [0, 0, %s], translate: [0, 2, 0]}\n"                                       \
    "render: {seed: %%d}\n"

static const struct method patch_methods[] = {
    {"pathtrace", {"estimator=pathtrace:samples=4096", "bounces=1", NULL}, 0},
    {"bdpt", {"estimator=bdpt:samples=512", "bounces=1", NULL}, 0.005},
    {"splat",
     {"estimator=splat", "injection=photon:count=150000", "bounces=1",
      "visibility=shadowmap:radius=0.15,step_back=auto", NULL},
     0.02},
    {"splat, full beams",
     {"estimator=splat", "injection=photon:count=150000", "bounces=1",
      "visibility=shadowmap:radius=0.15,step_back=full", NULL},
     0.02},
    {"photonmap",
     {"estimator=photonmap:neighbours=400", "injection=photon:count=150000", "bounces=1", NULL},
     0.02},
    {"vpl",
     {"estimator=vpl:lights=500,clamp=0", "injection=photon:count=500", "bounces=1", NULL},
     0.01},
    {"lightcuts",
     {"estimator=lightcuts:clamp=0", "injection=photon:count=5000", "bounces=1", NULL},
     0.01},
    {"gather",
     {"estimator=gather:samples=512", "injection=photon:count=500", "bounces=1", NULL},
     0},
    {"irradiance_cache", {"estimator=irradiance_cache:samples=20000", "bounces=1", NULL}, 0.01},
    {"voxel_cone", {"estimator=voxel_cone:cones=1024", "bounces=1", NULL}, 0.02},
    {"radiosity", {"estimator=radiosity:samples=64", "bounces=1", NULL}, 0.01},
};

static double patch_radiance(double tilt_degrees)
{
    double angle = 3 * PI / 180, flux = 2 * PI * 100 * (1 - cos(angle)), radius = tan(angle);
    double exitance = 0.8 * flux / (PI * radius * radius);
    double irradiance = exitance * radius * radius / (4 + radius * radius);
    return 0.5 / PI * irradiance * cos(tilt_degrees * PI / 180);
}

static void check_patch(const char *tilt)
{
    char scene[2048], name[64];
    snprintf(scene, sizeof scene, PATCH, tilt);
    snprintf(name, sizeof name, "lit patch, receiver tilted by %s", tilt);
    check(name, scene, patch_methods, COUNT(patch_methods), patch_radiance(strtod(tilt, NULL)));
}

static void test_lit_patch(void **state)
{
    (void)state;
    check_patch("0");
}

/* The cosine test: a splat's kernel lies across the beam and needs the receiver's cosine, a photon
 * map's lies in the surface and has none. At 60 degrees either mistake is a factor of two. */
static void test_receiver_cosine(void **state)
{
    (void)state;
    check_patch("60");
}

static void test_ambient(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=ambient:irradiance=2", NULL};
    expect_estimate("furnace: ambient", estimate_channel(furnace, choices, "indirect.G", 2),
                    0.6 / PI * 2, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_furnace),   cmocka_unit_test(test_large_furnace),
        cmocka_unit_test(test_lit_patch), SLOW_TEST(test_receiver_cosine),
        cmocka_unit_test(test_ambient),
    };
    return RUN_TESTS(tests);
}
