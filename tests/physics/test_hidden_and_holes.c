/* test_hidden_and_holes.c: what the camera does not see, and what is not there.
 *
 * An object with "camera: no" is not in the picture, but shadows and lights as if it were. A screen
 * of which a fine checker takes away half lets half of the light through, in shadow rays as for
 * photons, and a lamp with such holes shines half as much, whoever asks.
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
#define SEEDS 5

/* A floor under a lamp, with something between, seen from right above the floor and therefore
 * without it. The checker has holes of 1 / 40; the lamp is large beside what these shade. */
#define SCENE                                                                                      \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, %s, 0], look_at: [0, 0, 0], up: [0, 0, -1],\n"                         \
    "         projection: orthographic, width: 0.8}\n"                                             \
    "image: {width: 16, height: 16}\n"                                                             \
    "define:\n"                                                                                    \
    "  holes: {checker: {colors: [0, 1], scale: 0.025, translate: [0.007, 0.001, 0.004]}}\n"       \
    "materials:\n"                                                                                 \
    "  floor: {diffuse: 0.5}\n"                                                                    \
    "  gloss: {metal: {color: 0.9, roughness: 0.5}}\n"                                             \
    "  white: {diffuse: 0.8}\n"                                                                    \
    "  black: {diffuse: 0}\n"                                                                      \
    "  half: {diffuse: 0, opacity: =holes}\n"                                                      \
    "  mirror: {mirror: 1, opacity: =holes}\n"                                                     \
    "  lamp: {diffuse: 0, emission: 1}\n"                                                          \
    "  half_lamp: {diffuse: 0, emission: 2, opacity: =holes}\n"                                    \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: %s}\n"        \
    "  - quad: {corners: [[-0.5, 2, -0.5], [0.5, 2, -0.5], [0.5, 2, 0.5], [-0.5, 2, 0.5]],\n"      \
    "           material: %s, camera: no}\n"                                                       \
    "%s"                                                                                           \
    "render: {seed: %%d, passes: 4, light_samples: 16}\n"

/* Heights of the camera: below and above what is between. */
#define BELOW "0.4"
#define ABOVE "3"

#define BETWEEN(MATERIAL, MORE)                                                                    \
    "  - quad: {corners: [[-2, 1, 2], [2, 1, 2], [2, 1, -2], [-2, 1, -2]], material: " MATERIAL    \
        MORE "}\n"

/* Light that comes to the floor from below a white screen over it. */
static const char *const methods[][5] = {
    {"estimator=pathtrace:samples=32", "bounces=all", NULL},
    {"estimator=splat", "injection=photon:count=20000", "bounces=all",
     "visibility=shadowmap:radius=0.1", NULL},
    {"estimator=photonmap:neighbours=60", "injection=photon:count=20000", "bounces=all", NULL},
    {"estimator=final_gather:samples=16", "injection=photon:count=20000", "bounces=all", NULL},
    {"estimator=vpl:lights=200,clamp=0.05", "injection=photon:count=500", "bounces=all", NULL},
    {"estimator=gather:samples=16", "injection=photon:count=20000", "bounces=all", NULL},
    {"estimator=bdpt:samples=16", "bounces=all", NULL},
};

#define VPL 3 /* of these; too noisy for some */

static struct estimate measure(const char *height, const char *floor, const char *lamp,
                               const char *between, const char *channel,
                               const char *const choices[])
{
    char text[4096];
    snprintf(text, sizeof text, SCENE, height, floor, lamp, between);
    return estimate_channel(text, choices, channel, SEEDS);
}

static struct estimate direct_light(const char *floor, const char *lamp, const char *between)
{
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    return measure(BELOW, floor, lamp, between, "direct.G", choices);
}

static struct estimate times(double factor, struct estimate estimate)
{
    return (struct estimate){factor * estimate.mean, factor * estimate.standard_error};
}

/* --- hidden --------------------------------------------------------------------------------- */

static void test_hidden_is_not_seen(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    static const char hidden[] =
        "  - quad: {corners: [[-2, 2.5, 2], [2, 2.5, 2], [2, 2.5, -2], [-2, 2.5, -2]],"
        " material: white, camera: no}\n";
    struct estimate without = measure(ABOVE, "floor", "lamp", "", "direct.G", choices);
    struct estimate with = measure(ABOVE, "floor", "lamp", hidden, "direct.G", choices);
    assert_true(fabs(with.mean / without.mean - 1) < 1e-5);
    assert_true(without.mean > 0);
}

static void test_hidden_shadows(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    assert_true(
        measure(ABOVE, "floor", "lamp", BETWEEN("black", ", camera: no"), "direct.G", choices)
            .mean == 0);
}

/* A screen under the lamp's level but beside its light: it sends the floor's light back. */
#define BESIDE(MORE)                                                                               \
    "  - quad: {corners: [[0.5, 0, 1], [0.5, 0, -1], [0.5, 1.5, -1], [0.5, 1.5, 1]], material: "   \
    "white" MORE "}\n"

static void test_hidden_lights(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(methods); i++) {
        struct estimate seen =
            measure(BELOW, "floor", "lamp", BESIDE(""), "indirect.G", methods[i]);
        struct estimate hidden =
            measure(BELOW, "floor", "lamp", BESIDE(", camera: no"), "indirect.G", methods[i]);
        print_message("hidden screen, %s: %.6f, seen %.6f\n", methods[i][0], hidden.mean,
                      seen.mean);
        assert_true(fabs(hidden.mean / seen.mean - 1) < 1e-5);
        assert_true(hidden.mean > 0);
    }
}

/* --- holes ---------------------------------------------------------------------------------- */

static void test_holes_let_half_of_the_light_through(void **state)
{
    (void)state;
    expect_agreement("black screen with holes, direct light",
                     direct_light("floor", "lamp", BETWEEN("half", "")),
                     times(0.5, direct_light("floor", "lamp", "")), 0.01);
}

/* Light that comes through twice, off a white ceiling over the screen, which the lamp lights
 * from below: a screen of black halves dims the floor's light to half, and nothing comes back
 * from it. */
#define CEILING                                                                                    \
    "  - quad: {corners: [[-2, 3, 2], [2, 3, 2], [2, 3, -2], [-2, 3, -2]], material: white}\n"     \
    "  - quad: {corners: [[-0.5, 2.1, 0.5], [0.5, 2.1, 0.5], [0.5, 2.1, -0.5],"                    \
    " [-0.5, 2.1, -0.5]], material: lamp}\n"

static void test_photons_through_holes(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(methods); i++) {
        struct estimate with =
            measure(BELOW, "floor", "black", CEILING BETWEEN("half", ""), "indirect.G", methods[i]);
        struct estimate without =
            measure(BELOW, "floor", "black", CEILING, "indirect.G", methods[i]);
        char what[128];
        snprintf(what, sizeof what, "screen with holes: %s", methods[i][0]);
        expect_agreement(what, with, times(0.5, without), 0.02);
    }
}

static void test_lamp_with_holes(void **state)
{
    (void)state;
    expect_agreement("lamp with holes over a diffuse floor", direct_light("floor", "half_lamp", ""),
                     direct_light("floor", "lamp", ""), 0.005);
    expect_agreement("lamp with holes over a metal floor", direct_light("gloss", "half_lamp", ""),
                     direct_light("gloss", "lamp", ""), 0.005);
    for (size_t i = 0; i < VPL; i++) {
        char what[128];
        snprintf(what, sizeof what, "lamp with holes: %s", methods[i][0]);
        expect_agreement(
            what, measure(BELOW, "floor", "half_lamp", BESIDE(""), "indirect.G", methods[i]),
            measure(BELOW, "floor", "lamp", BESIDE(""), "indirect.G", methods[i]), 0.01);
    }
}

/* Spheres have holes as meshes do, also by the material of an instance. */
static void test_spheres_with_holes(void **state)
{
    (void)state;
    static const char ball[] =
        "  - sphere: {center: [0, 1, 0], radius: 0.6, material: half, camera: no}\n";
    static const char instance[] =
        "  - instance: {of: ball, material: half, camera: no}\n"
        "groups: {ball: [{sphere: {center: [0, 1, 0], radius: 0.6, material: white}}]}\n";
    struct estimate lit = direct_light("floor", "lamp", "");
    struct estimate through = direct_light("floor", "lamp", ball);
    assert_true(fabs(direct_light("floor", "lamp", instance).mean / through.mean - 1) < 1e-5);
    /* Two walls with half of the way open, which the middle of the floor sees all over the lamp. */
    print_message("light through the ball's two walls: %.4f\n", through.mean / lit.mean);
    assert_true(through.mean / lit.mean > 0.2 && through.mean / lit.mean < 0.35);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hidden_is_not_seen),
        cmocka_unit_test(test_hidden_shadows),
        SLOW_TEST(test_hidden_lights),
        cmocka_unit_test(test_holes_let_half_of_the_light_through),
        SLOW_TEST(test_photons_through_holes),
        SLOW_TEST(test_lamp_with_holes),
        cmocka_unit_test(test_spheres_with_holes),
    };
    return RUN_TESTS(tests);
}
