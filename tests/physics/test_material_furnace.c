/* test_material_furnace.c: white furnaces: what absorbs nothing can't be seen.
 *
 * Where all that is there reflects or transmits all of its light, radiance L from all around is the
 * radiance everywhere, by any number of bounces (inside of glass of index n it is n^2 L): each
 * pixel shows L. Two furnaces: an object on a white floor under a sky of radiance 1; and an object
 * in a hollow sphere that emits e and has albedo a, where L = e / (1 - a), here 1; there a white
 * ball stands inside of the object, which glass, holes and all may show.
 *
 * Direct and indirect light together make 1, so the bias that is allowed is a share of the whole.
 */
#include "support/statistics_of.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define SEEDS 10
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

struct method {
    const char *name;
    const char *choices[6];
    double bias;
};

#define MATERIALS                                                                                  \
    "materials:\n"                                                                                 \
    "  floor: {diffuse: 1}\n"                                                                      \
    "  wall: {diffuse: 0.5, emission: 0.5, emission_both: yes}\n"                                  \
    "  polished: {mirror: 1}\n"                                                                    \
    "  brushed: {metal: {color: 1, roughness: 0.5}}\n"                                             \
    "  object: %s\n"

#define HOLES "{diffuse: 1, opacity: {checker: {colors: [0, 1], scale: 0.3}}}"

/* What the object is made of. */
static const char *const materials[] = {
    "{diffuse: 1}",
    "{mirror: 1}",
    "{metal: {color: 1, roughness: 0.4}}",
    "{metal: {color: 1, roughness: 0.9}}",
    "{glossy: {diffuse: 1, specular: 0.04, roughness: 0}}",
    "{glossy: {diffuse: 1, specular: 0.3, roughness: 0.5}}",
    "{dielectric: {ior: 1.5}}",
    "{mix: [{material: floor, weight: 0.4}, {material: polished, weight: 0.3},"
    " {material: brushed, weight: 0.3}]}",
    "{glossy: {diffuse: 1, specular: {checker: {colors: [0.04, 0.8], scale: 0.3}},"
    " roughness: {noise: {colors: [0.1, 0.9], scale: 0.3}}}}",
    HOLES,
};

static const char sky[] =
    "psd: 1\n"
    "camera: {location: [0, 2.2, 5], look_at: [0, 0.8, 0], angle: 30}\n"
    "image: {width: 24, height: 24}\n" MATERIALS "lights: [{sky: {radiance: 1}}]\n"
    "objects:\n"
    "  - quad: {corners: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: floor}\n"
    "  - sphere: {center: [0, 1, 0], radius: 0.9, material: object}\n"
    "render: {seed: %%d, light_samples: 32}\n";

static const char enclosure[] = "psd: 1\n"
                                "camera: {location: [0, 0.5, 1.6], look_at: [0, 0, 0], angle: 70}\n"
                                "image: {width: 24, height: 24}\n" MATERIALS "objects:\n"
                                "  - sphere: {center: [0, 0, 0], radius: 2, material: wall}\n"
                                "  - sphere: {center: [0, 0, 0], radius: 0.7, material: object}\n"
                                "  - sphere: {center: [0, 0, 0], radius: 0.4, material: floor}\n"
                                "render: {seed: %%d, light_samples: 32}\n";

static void check(const char *name, const char *scene, const struct method *methods, size_t count,
                  const char *material)
{
    char text[2048], what[256];
    snprintf(text, sizeof text, scene, material);
    for (size_t i = 0; i < count; i++) {
        snprintf(what, sizeof what, "%s, %s: %s", name, methods[i].name, material);
        expect_estimate(what, estimate_channel(text, methods[i].choices, "G", SEEDS), 1,
                        methods[i].bias);
    }
}

static const struct method path_tracing[] = {
    {"pathtrace", {"estimator=pathtrace:samples=8", "bounces=all", NULL}, 0},
    {"bdpt", {"estimator=bdpt:samples=8", "bounces=all", NULL}, 0.005},
};

/* A photon map's discs miss some of a small sphere, and too much of one with holes, which is last
 * above. */
static const struct method photons[] = {
    {"gather",
     {"estimator=gather:samples=8", "injection=photon:count=6000", "bounces=all", NULL},
     0.01},
    {"splat",
     {"estimator=splat", "injection=photon:count=6000", "bounces=all",
      "visibility=shadowmap:radius=0.05", NULL},
     0.01},
    {"final_gather",
     {"estimator=final_gather:samples=16", "injection=photon:count=6000", "bounces=all", NULL},
     0.015},
    {"photonmap, gather",
     {"estimator=photonmap:neighbours=40,gather=8", "injection=photon:count=6000", "bounces=all",
      NULL},
     0.01},
    {"photonmap",
     {"estimator=photonmap:neighbours=40", "injection=photon:count=6000", "bounces=all", NULL},
     0.02},
};

static void test_path_tracing_under_a_sky(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(materials); i++)
        check("sky", sky, path_tracing, COUNT(path_tracing), materials[i]);
}

static void test_path_tracing_enclosed(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(materials); i++)
        check("enclosed", enclosure, path_tracing, COUNT(path_tracing), materials[i]);
}

static void test_photons_enclosed(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(materials); i++)
        check("enclosed", enclosure, photons, i + 1 < COUNT(materials) ? COUNT(photons) : 2,
              materials[i]);
}

/* Virtual lights leave caustics out, and so claim diffuse surfaces alone. */
static void test_virtual_lights(void **state)
{
    (void)state;
    static const struct method methods[] = {
        {"vpl",
         {"estimator=vpl:lights=500,clamp=0.02", "injection=photon:count=500", "bounces=all", NULL},
         0.01},
        {"lightcuts",
         {"estimator=lightcuts:clamp=0.02", "injection=photon:count=500", "bounces=all", NULL},
         0.01},
    };
    check("enclosed", enclosure, methods, COUNT(methods), "{diffuse: 1}");
    check("enclosed", enclosure, methods, COUNT(methods), HOLES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_path_tracing_under_a_sky),
        SLOW_TEST(test_path_tracing_enclosed),
        SLOW_TEST(test_photons_enclosed),
        cmocka_unit_test(test_virtual_lights),
    };
    return RUN_TESTS(tests);
}
