/* test_material_agreement.c: the estimators against one another in rooms with mirrors, gloss, glass
 * and metal.
 *
 * A closed room under a lamp; path tracing is the truth. Splats and photon maps may be off by their
 * own bias, in the mean of the indirect layer and of the whole picture. Light goes by all ways at
 * once: mirrors seen by the camera and by light paths, caustics, gloss that mirrors lamp and walls.
 */
#include "support/render_scene.h"
#include "support/statistics_of.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define SEEDS 4

/* The materials of the floor and of the right wall, and what stands in the room. */
static const char room[] =
    "psd: 1\n"
    "camera: {location: [0, 1.2, 1.9], look_at: [0.15, 0.8, 0], angle: 80}\n"
    "image: {width: 32, height: 24}\n"
    "materials:\n"
    "  white: {diffuse: 0.6}\n"
    "  mirror: {mirror: 0.9}\n"
    "  gloss: {glossy: {diffuse: 0.5, specular: 0.2, roughness: 0.3}}\n"
    "  glass: {dielectric: {ior: 1.5, absorption: 0.3}}\n"
    "  metal: {metal: {color: 0.8, roughness: 0.45}}\n"
    "lights:\n"
    "  - rectangle: {corners: [[-0.5, 1.99, -0.5], [0.5, 1.99, -0.5], [0.5, 1.99, 0.5],\n"
    "                          [-0.5, 1.99, 0.5]], radiance: 1}\n"
    "objects:\n"
    "  - quad: {corners: [[-1, 0, 2], [1, 0, 2], [1, 0, -1], [-1, 0, -1]], material: %s}\n"
    "  - quad: {corners: [[-1, 2, 2], [1, 2, 2], [1, 2, -1], [-1, 2, -1]], material: white}\n"
    "  - quad: {corners: [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]], material: white}\n"
    "  - quad: {corners: [[-1, 0, 2], [1, 0, 2], [1, 2, 2], [-1, 2, 2]], material: white}\n"
    "  - quad: {corners: [[-1, 0, -1], [-1, 2, -1], [-1, 2, 2], [-1, 0, 2]], material: white}\n"
    "  - quad: {corners: [[1, 0, -1], [1, 2, -1], [1, 2, 2], [1, 0, 2]], material: %s}\n"
    "%s"
    "render: {seed: %d, light_samples: 8}\n";

struct method {
    const char *name;
    const char *choices[6];
    double bias; /* of the indirect layer */
};

static const struct method truth = {
    "pathtrace", {"estimator=pathtrace:samples=64", "bounces=all", NULL}, 0};

static const struct method methods[] = {
    {"bdpt", {"estimator=bdpt:samples=32", "bounces=all", NULL}, 0.005},
    {"gather",
     {"estimator=gather:samples=16", "injection=photon:count=20000", "bounces=all", NULL},
     0.01},
    {"splat",
     {"estimator=splat", "injection=photon:count=20000", "bounces=all",
      "visibility=shadowmap:radius=0.05", NULL},
     0.02},
    {"photonmap",
     {"estimator=photonmap:neighbours=40", "injection=photon:count=20000", "bounces=all", NULL},
     0.02},
    {"final_gather",
     {"estimator=final_gather:samples=16", "injection=photon:count=20000", "bounces=all", NULL},
     0.015},
    {"photonmap, gather",
     {"estimator=photonmap:neighbours=30,gather=16", "injection=photon:count=20000", "bounces=all",
      NULL},
     0.03},
};

struct pair {
    struct estimate indirect, whole;
};

static struct pair means(const char *floor, const char *wall, const char *object,
                         const struct method *method)
{
    double indirect[SEEDS], whole[SEEDS];
    char text[4096];
    for (int seed = 0; seed < SEEDS; seed++) {
        snprintf(text, sizeof text, room, floor, wall, object, seed);
        struct rendering rendering = render_text(text, 2, method->choices);
        indirect[seed] = mean_of_all(&rendering.image, "indirect.G");
        whole[seed] = mean_of_all(&rendering.image, "G");
        rendering_release(&rendering);
    }
    return (struct pair){estimate_of(indirect, SEEDS), estimate_of(whole, SEEDS)};
}

static void check(const char *name, const char *floor, const char *wall, const char *object)
{
    struct pair expected = means(floor, wall, object, &truth);
    for (size_t i = 0; i < COUNT(methods); i++) {
        struct pair got = means(floor, wall, object, &methods[i]);
        char what[128];
        snprintf(what, sizeof what, "%s, %s: indirect layer", name, methods[i].name);
        expect_agreement(what, got.indirect, expected.indirect, methods[i].bias);
        snprintf(what, sizeof what, "%s, %s: whole picture", name, methods[i].name);
        expect_agreement(what, got.whole, expected.whole, 0.6 * methods[i].bias);
    }
}

static void test_mirror_wall(void **state)
{
    (void)state;
    check("mirror wall", "white", "mirror", "");
}

static void test_glossy_floor(void **state)
{
    (void)state;
    check("glossy floor", "gloss", "white", "");
}

static void test_glass_slab(void **state)
{
    (void)state;
    check("glass slab", "white", "white",
          "  - box: {corners: [[-0.7, 0.2, -0.7], [0.8, 0.5, 1]], material: glass}\n");
}

static void test_metal_sphere(void **state)
{
    (void)state;
    check("metal sphere", "white", "white",
          "  - sphere: {center: [0.2, 0.6, 0], radius: 0.5, material: metal}\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mirror_wall),
        SLOW_TEST(test_glossy_floor),
        SLOW_TEST(test_glass_slab),
        SLOW_TEST(test_metal_sphere),
    };
    return RUN_TESTS(tests);
}
