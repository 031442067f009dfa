/* test_bdpt.c: bidirectional path tracing: each way of finding light alone, and all of them
 * weighed, have one mean.
 *
 * Weights that do not add up to 1 for some path, because two sides see another density, show as
 * light that is missing or is counted twice. A point light of intensity I in the middle of a sphere
 * of radius r and albedo a gives a / pi times E0 = I / r^2 times the sum of a^k over the bounces k;
 * other lights and surfaces are compared with path tracing.
 */
#include "support/lit_room.h"
#include "support/render_scene.h"
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
#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define SEEDS 4

static const char *const strategies[] = {"all", "camera", "light"};

static struct estimate measure(const char *text, const char *estimator, const char *bounces)
{
    const char *const choices[] = {estimator, bounces, NULL};
    return estimate_channel(text, choices, "indirect.G", SEEDS);
}

/* The scene in a larger picture than SCENE_HEAD has: at its borders light tracing takes in what
 * lies half a pixel beyond. */
static void enlarge(const char *scene, char text[4096])
{
    static const char small[] = "width: 16, height: 9}";
    const char *place = strstr(scene, small);
    assert_non_null(place);
    int length = snprintf(text, 4096, "%.*swidth: 80, height: 45}%s", (int)(place - scene), scene,
                          place + strlen(small));
    assert_true(length > 0 && length < 4096);
}

static struct estimate by_strategies(const char *text, const char *which, const char *bounces)
{
    char estimator[64];
    snprintf(estimator, sizeof estimator, "estimator=bdpt:samples=8,strategies=%s", which);
    return measure(text, estimator, bounces);
}

static void test_each_strategy_in_a_sphere(void **state)
{
    (void)state;
    static const char sphere[] =
        "psd: 1\n"
        "camera: {location: [0, 0, 0], look_at: [1, 0.3, 0.2], angle: 90}\n"
        "image: {width: 96, height: 96}\n"
        "materials: {wall: {diffuse: 0.5}}\n"
        "lights: [{point: {location: [0, 0, 0], intensity: 4}}]\n"
        "objects: [{sphere: {center: [0, 0, 0], radius: 2, material: wall}}]\n"
        "render: {seed: %d}\n";
    static const struct {
        const char *bounces;
        double sum;
    } cases[] = {{"bounces=1", 0.5}, {"bounces=2", 0.75}, {"bounces=3", 0.875}, {"bounces=all", 1}};
    for (size_t i = 0; i < COUNT(cases); i++)
        for (size_t k = 0; k < COUNT(strategies); k++) {
            char what[64];
            snprintf(what, sizeof what, "sphere, %s: %s", cases[i].bounces, strategies[k]);
            expect_estimate(what, by_strategies(sphere, strategies[k], cases[i].bounces),
                            0.5 / PI * cases[i].sum, 0.005);
        }
}

/* Of radiance L that shines to its inside: E = pi L directly, and albedo times that with each
 * bounce. Light paths start on the very surface that they meet. */
static void test_shining_sphere(void **state)
{
    (void)state;
    static const char sphere[] =
        "psd: 1\n"
        "camera: {location: [100, 0, 0], look_at: [101, 0.3, 0.2], angle: 90}\n"
        "image: {width: 48, height: 48}\n"
        "materials: {wall: {diffuse: 0.5, emission: 1, emission_both: yes}}\n"
        "objects: [{sphere: {center: [100, 0, 0], radius: 2, material: wall}}]\n"
        "render: {seed: %d}\n";
    expect_estimate("shining sphere", measure(sphere, "estimator=bdpt:samples=64", "bounces=2"),
                    0.5 * (0.5 + 0.25), 0.001);
}

#define SEEDED "render: {seed: %d, passes: 8}\n"

/* Where light tracing finds all light; at corners of pixels that show two surfaces it is not
 * exact. */
static void test_each_strategy_by_lights(void **state)
{
    (void)state;
    static const struct lit_scene scenes[] = {
        {"spotlight, tight", SCENE_HEAD LIGHTS TIGHT_SPOT ROOM_OBJECTS SEEDED},
        {"sun", SCENE_HEAD LIGHTS SUN ROOM_OBJECTS SEEDED},
        {"sun of 20 degrees and sky", SCENE_HEAD LIGHTS WIDE_SUN SKY ROOM_OBJECTS SEEDED},
        {"rectangle of two sides", SCENE_HEAD LIGHTS RECTANGLE ROOM_OBJECTS SEEDED},
        {"sphere", SCENE_HEAD LIGHTS BALL ROOM_OBJECTS SEEDED},
        {"point, sun and sphere", SCENE_HEAD LIGHTS POINT SUN BALL ROOM_OBJECTS SEEDED},
    };
    for (size_t i = 0; i < COUNT(scenes); i++) {
        char text[4096];
        enlarge(scenes[i].text, text);
        struct estimate truth = measure(text, "estimator=pathtrace:samples=64", "bounces=all");
        for (size_t k = 0; k < COUNT(strategies); k++) {
            char what[128];
            snprintf(what, sizeof what, "%s: %s", scenes[i].name, strategies[k]);
            expect_agreement(what, by_strategies(text, strategies[k], "bounces=all"), truth, 0.01);
        }
    }
}

/* Surfaces with more than one lobe: which scatterings count as bounces. A lamp with a pattern, so
 * that its points differ. */
#define ROOM(FLOOR)                                                                                \
    SCENE_HEAD                                                                                     \
    "  lamp: {diffuse: 0.3, emission: {checker: {colors: [0, [9, 8, 7]], scale: 0.17}}}\n"         \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: " FLOOR "}\n" \
    "  - quad: {corners: [[-2, 0, -2], [2, 0, -2], [2, 3, -2], [-2, 3, -2]], material: red}\n"     \
    "  - quad: {corners: [[-2, 0, 2], [-2, 0, -2], [-2, 3, -2], [-2, 3, 2]], material: blue}\n"    \
    "  - quad: {corners: [[-1, 2.5, -1], [0.5, 2.5, -1], [0.5, 2.5, 0.5], [-1, 2.5, 0.5]],\n"      \
    "           material: lamp}\n"                                                                 \
    "  - sphere: {center: [0.9, 0.6, 0.2], radius: 0.6, material: white}\n" SEEDED

static void test_bounces_by_lobes(void **state)
{
    (void)state;
    static const struct lit_scene rooms[] = {
        {"white", ROOM("white")}, {"gloss", ROOM("gloss")}, {"mirror", ROOM("mirror")}};
    static const char *const bounces[] = {"bounces=1", "bounces=2", "bounces=all"};
    for (size_t i = 0; i < COUNT(rooms); i++)
        for (size_t k = 0; k < COUNT(bounces); k++) {
            char what[128], text[4096];
            enlarge(rooms[i].text, text);
            snprintf(what, sizeof what, "%s floor, %s", rooms[i].name, bounces[k]);
            expect_agreement(what, by_strategies(text, "all", bounces[k]),
                             measure(text, "estimator=pathtrace:samples=64", bounces[k]), 0.01);
        }
}

/* Over passes, whose means over pixels path tracing has, too. */
static void test_scenes(void **state)
{
    (void)state;
    static const char *const scenes[] = {"corridor", "columns"};
    for (size_t i = 0; i < COUNT(scenes); i++) {
        char *text = scene_file_text(scenes[i], 96, 54), seeded[8192];
        int length = snprintf(seeded, sizeof seeded, "%s\nrender: {seed: %%d, passes: 16}\n", text);
        assert_true(length > 0 && (size_t)length < sizeof seeded);
        free(text);
        expect_agreement(scenes[i], by_strategies(seeded, "all", "bounces=all"),
                         measure(seeded, "estimator=pathtrace:samples=64", "bounces=all"), 0.003);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_strategy_in_a_sphere),
        cmocka_unit_test(test_shining_sphere),
        SLOW_TEST(test_each_strategy_by_lights),
        SLOW_TEST(test_bounces_by_lobes),
        SLOW_TEST(test_scenes),
    };
    return RUN_TESTS(tests);
}
