/* test_shading_normals.c: smoothed and bent normals, under which light must go the same way for
 * camera paths and light paths (Veach 1997, section 5.3).
 *
 * A convex object, or a floor, does not light itself, whatever its normals say; but a floor lights
 * the foot of a wall. A sphere of smooth triangles is a sphere. In a room with a bumpy floor, where
 * no closed form helps, path tracing is the truth for the others.
 */
#include "support/render_scene.h"
#include "support/statistics_of.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define SEEDS 4

struct method {
    const char *name;
    const char *choices[6];
    double bias;
};

static const struct method truth = {
    "pathtrace", {"estimator=pathtrace:samples=64", "bounces=all", NULL}, 0};

/* The discs of a photon map follow the bent normal, and miss photons of a bumpy floor: the more,
 * the steeper it is. */
enum { ANY_SLOPE = 3 }; /* how many of them know no such limit */
static const struct method methods[] = {
    {"bdpt", {"estimator=bdpt:samples=32", "bounces=all", NULL}, 0.01},
    {"gather",
     {"estimator=gather:samples=16", "injection=photon:count=12000", "bounces=all", NULL},
     0.01},
    {"splat",
     {"estimator=splat", "injection=photon:count=12000", "bounces=all",
      "visibility=shadowmap:radius=0.05", NULL},
     0.01},
    {"photonmap",
     {"estimator=photonmap:neighbours=40", "injection=photon:count=12000", "bounces=all", NULL},
     0.04},
    {"photonmap, gather",
     {"estimator=photonmap:neighbours=40,gather=16", "injection=photon:count=12000", "bounces=all",
      NULL},
     0.05},
    {"vpl",
     {"estimator=vpl:lights=300,clamp=0.05", "injection=photon:count=500", "bounces=all", NULL},
     0.02},
};

/* --- alone ---------------------------------------------------------------------------------- */

static const char alone[] =
    "psd: 1\n"
    "camera: {location: [0, 3, 1], look_at: [0, 0, 0], projection: orthographic, width: 1.4}\n"
    "image: {width: 24, height: 24}\n"
    "materials:\n"
    "  bumpy: {diffuse: 0.8, bump: {noise: {colors: [0, 0.3], scale: 0.3, octaves: 1}}}\n"
    "  plain: {diffuse: 0.8}\n"
    "lights: [{point: {location: [0.5, 2, 0.3], intensity: 4}}]\n"
    "objects:\n"
    "  - %s\n";

static void expect_no_indirect_light(const char *object)
{
    char text[2048];
    snprintf(text, sizeof text, alone, object);
    for (size_t i = 0; i < COUNT(methods) + 1; i++) {
        const struct method *method = i < COUNT(methods) ? &methods[i] : &truth;
        struct rendering rendering = render_text(text, 2, method->choices);
        double share =
            mean_of_all(&rendering.image, "indirect.G") / mean_of_all(&rendering.image, "direct.G");
        print_message("%.40s, %s: indirect / direct %.6f\n", object, method->name, share);
        assert_true(share < 1e-3);
        rendering_release(&rendering);
    }
}

static void test_no_light_of_its_own(void **state)
{
    (void)state;
    expect_no_indirect_light(
        "quad: {corners: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: bumpy}");
    expect_no_indirect_light("sphere: {center: [0, 0, 0], radius: 0.8, material: bumpy}");
    expect_no_indirect_light(
        "cylinder: {from: [0, -0.5, 0], to: [0, 0.3, 0], radius: 0.7, segments: 12,"
        " material: plain}");
}

/* --- creases -------------------------------------------------------------------------------- */

/* A wall, seen at one height above the floor that it stands on. */
static const char crease[] =
    "psd: 1\n"
    "camera: {location: [0, %g, 1.5], look_at: [0, %g, 0], projection: orthographic, width: 1e-7}\n"
    "image: {width: 16, height: 16}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights:\n"
    "  - rectangle: {corners: [[-1, 2, 0.5], [1, 2, 0.5], [1, 2, 1.5]], radiance: 1}\n"
    "objects:\n"
    "  - quad: {corners: [[-2, 0, 0], [-2, 0, 2], [2, 0, 2], [2, 0, 0]], material: white}\n"
    "  - quad: {corners: [[-2, 0, 0], [2, 0, 0], [2, 2, 0], [-2, 2, 0]], material: white}\n";

static double light_of_wall(double height, const struct method *method)
{
    char text[1024];
    snprintf(text, sizeof text, crease, height, height);
    struct rendering rendering = render_text(text, 2, method->choices);
    double mean = mean_of_all(&rendering.image, "indirect.G");
    rendering_release(&rendering);
    return mean;
}

/* As near to the floor as rays start from surfaces, the wall lies in the floor's plane too. */
static void test_crease(void **state)
{
    (void)state;
    static const struct method paths[] = {
        {"pathtrace", {"estimator=pathtrace:samples=256", NULL}, 0},
        {"bdpt", {"estimator=bdpt:samples=256", NULL}, 0},
        {"gather", {"estimator=gather:samples=256", NULL}, 0},
    };
    for (size_t i = 0; i < COUNT(paths); i++) {
        double ratio = light_of_wall(1e-5, &paths[i]) / light_of_wall(1e-3, &paths[i]);
        print_message("wall in the crease / above it, %s: %.3f\n", paths[i].name, ratio);
        assert_true(fabs(ratio - 1) < 0.05);
    }
}

/* --- rooms ---------------------------------------------------------------------------------- */

/* The floor's material, and what stands on it. */
static const char room[] =
    "psd: 1\n"
    "camera: {location: [0, 1.4, 1.9], look_at: [0, 0.5, 0], angle: 70}\n"
    "image: {width: 24, height: 24}\n"
    "materials:\n"
    "  white: {diffuse: 0.6}\n"
    "  bumpy: {diffuse: 0.6, bump: {noise: {colors: [0, 0.15], scale: 0.3, octaves: 2}}}\n"
    "  craggy: {diffuse: 0.6, bump: {noise: {colors: [0, 0.5], scale: 0.3, octaves: 2}}}\n"
    "  coated: {glossy: {diffuse: 0.6, specular: 0.2, roughness: 0.4},\n"
    "           bump: {noise: {colors: [0, 0.15], scale: 0.3, octaves: 2}}}\n"
    "  metal: {metal: {color: 0.9, roughness: 0.4}}\n"
    "  glass: {dielectric: {ior: 1.5}}\n"
    "lights:\n"
    "  - rectangle: {corners: [[-0.5, 1.99, -0.5], [0.5, 1.99, -0.5], [0.5, 1.99, 0.5]],\n"
    "                radiance: 1}\n"
    "objects:\n"
    "  - quad: {corners: [[-1, 0, 2], [1, 0, 2], [1, 0, -1], [-1, 0, -1]], material: %s}\n"
    "  - quad: {corners: [[-1, 2, 2], [1, 2, 2], [1, 2, -1], [-1, 2, -1]], material: white}\n"
    "  - quad: {corners: [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]], material: white}\n"
    "  - quad: {corners: [[-1, 0, 2], [1, 0, 2], [1, 2, 2], [-1, 2, 2]], material: white}\n"
    "  - quad: {corners: [[-1, 0, -1], [-1, 2, -1], [-1, 2, 2], [-1, 0, 2]], material: white}\n"
    "  - quad: {corners: [[1, 0, -1], [1, 2, -1], [1, 2, 2], [1, 0, 2]], material: white}\n"
    "%s"
    "render: {seed: %%d, light_samples: 16}\n";

static struct estimate indirect_light(const char *floor, const char *object,
                                      const struct method *method)
{
    char text[4096];
    snprintf(text, sizeof text, room, floor, object);
    return estimate_channel(text, method->choices, "indirect.G", SEEDS);
}

static void agree(const char *floor, size_t first, size_t end)
{
    struct estimate expected = indirect_light(floor, "", &truth);
    for (size_t i = first; i < end; i++) {
        char what[128];
        snprintf(what, sizeof what, "%s floor, %s / path tracing", floor, methods[i].name);
        expect_agreement(what, indirect_light(floor, "", &methods[i]), expected, methods[i].bias);
    }
}

static void test_bumpy_floor(void **state)
{
    (void)state;
    agree("craggy", 0, ANY_SLOPE);
    agree("bumpy", ANY_SLOPE, COUNT(methods));
    agree("coated", 0, COUNT(methods) - 1); /* vpl knows no gloss */
}

/* A sphere that is scaled unevenly, by next to nothing, is made of smooth triangles. */
static void compare_spheres(const char *material, const struct method *method)
{
    char round[128], mesh[160];
    snprintf(round, sizeof round, "  - sphere: {center: [0, 0.7, 0], radius: 0.6, material: %s}\n",
             material);
    snprintf(mesh, sizeof mesh,
             "  - sphere: {center: [0, 0.7, 0], radius: 0.6, material: %s, scale: [1, 1, 1.001]}\n",
             material);
    /* By the same random numbers, so that their noise is nearly the same too. */
    double ratio =
        indirect_light("white", mesh, method).mean / indirect_light("white", round, method).mean;
    print_message("smooth %s mesh / sphere, %s: %.5f\n", material, method->name, ratio);
    assert_true(fabs(ratio - 1) < 0.01);
}

static void test_smooth_sphere(void **state)
{
    (void)state;
    static const char *const materials[] = {"white", "metal", "glass"};
    for (size_t i = 0; i < COUNT(materials); i++) {
        compare_spheres(materials[i], &truth);
        compare_spheres(materials[i], &methods[0]);
        compare_spheres(materials[i], &methods[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_light_of_its_own),
        cmocka_unit_test(test_crease),
        cmocka_unit_test(test_bumpy_floor),
        SLOW_TEST(test_smooth_sphere),
    };
    return RUN_TESTS(tests);
}
