/* test_many_lights.c: pictures whose points draw some of the lights have the mean of those whose
 * points ask all of them.
 *
 * Direct light, light at the end of paths, splats, and gloss, which weighs a light that was drawn
 * against one that was hit. light_choices of 256 asks all of up to 512 lights.
 */
#include "support/render_scene.h"
#include "support/statistics_of.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define SEEDS 4

/* A room of 8 x 3 x 8 with a block, and a grid of lights below its ceiling; its floor is of the
 * material named. */
static const char scene[] =
    "psd: 1\n"
    "camera: {location: [-3.5, 1.5, 3.5], look_at: [0.5, 0.6, -0.5], angle: 75}\n"
    "image: {width: 32, height: 18}\n"
    "materials:\n"
    "  white: {diffuse: 0.7}\n"
    "  gloss: {glossy: {diffuse: 0.2, specular: 0.6, roughness: 0.15}}\n"
    "  lamp: {diffuse: 0, emission: [60, 50, 40]}\n"
    "groups:\n"
    "  bulb: [sphere: {center: [0, 0, 0], radius: 0.03, material: lamp}]\n"
    "objects:\n"
    "  - box: {corners: [[-4, -0.1, -4], [4, 0, 4]], material: %s}\n"
    "  - box: {corners: [[-4, 3, -4], [4, 3.1, 4]], material: white}\n"
    "  - box: {corners: [[-4.1, 0, -4], [-4, 3, 4]], material: white}\n"
    "  - box: {corners: [[4, 0, -4], [4.1, 3, 4]], material: white}\n"
    "  - box: {corners: [[-4, 0, -4.1], [4, 3, -4]], material: white}\n"
    "  - box: {corners: [[-4, 0, 4], [4, 3, 4.1]], material: white}\n"
    "  - box: {corners: [[0, 0, -1.5], [1.5, 1.4, 0]], material: white}\n"
    "%s"
    "render: {seed: %%d, light_choices: %d, light_samples: 4, aa_samples: 1}\n";

#define GRID                                                                                       \
    "  - for: i\n"                                                                                 \
    "    from: 0\n"                                                                                \
    "    to: 11\n"                                                                                 \
    "    do:\n"                                                                                    \
    "      for: k\n"                                                                               \
    "      from: 0\n"                                                                              \
    "      to: 11\n"                                                                               \
    "      do:\n"
#define PLACE "[=0.6*i-3.3, '=2.2+0.5*sin(3*i+5*k)', =0.6*k-3.3]"

static const char bulbs[] = GRID "        instance: {of: bulb, translate: " PLACE "}\n";

static const char points[] =
    "lights:\n" GRID "        point: {location: " PLACE ", intensity: 0.2}\n"
    "  - spotlight: {location: [0, 2.9, 2], point_at: [0, 0, 2], radius: 30, falloff: 40,\n"
    "                intensity: 20}\n"
    "  - sky: {radiance: 0.1}\n";

/* Nine, of which pixels ask all and points that paths meet draw two. */
static const char few_bulbs[] =
    "  - for: i\n"
    "    from: 0\n"
    "    to: 8\n"
    "    do: {instance: {of: bulb, translate: [=0.9*i-3.6, '=2.2+0.5*sin(3*i)', '=3*cos(5*i)']}}\n";

static struct estimate render_with(const char *material, const char *lights, int choices,
                                   const char *estimator, const char *channel)
{
    const char *const words[] = {estimator, "denoiser=none", NULL};
    char text[4096];
    snprintf(text, sizeof text, scene, material, lights, choices);
    return estimate_channel(text, words, channel, SEEDS);
}

static void expect_alike(const char *material, const char *lights, const char *estimator,
                         const char *channel, double tolerance)
{
    struct estimate all = render_with(material, lights, 256, estimator, channel);
    struct estimate some = render_with(material, lights, 8, estimator, channel);
    char what[160];
    snprintf(what, sizeof what, "%s, %s, %s", material, estimator, channel);
    expect_agreement(what, some, all, tolerance);
}

static void test_direct_light_of_points(void **state)
{
    (void)state;
    expect_alike("white", points, "estimator=ambient:irradiance=0", "direct.G", 0.005);
}

static void test_direct_light_of_bulbs(void **state)
{
    (void)state;
    expect_alike("white", bulbs, "estimator=ambient:irradiance=0", "direct.G", 0.005);
}

static void test_paths(void **state)
{
    (void)state;
    expect_alike("white", points, "estimator=pathtrace:samples=16", "indirect.G", 0.01);
    expect_alike("white", bulbs, "estimator=pathtrace:samples=16", "indirect.G", 0.01);
    expect_alike("white", few_bulbs, "estimator=pathtrace:samples=16", "indirect.G", 0.01);
}

/* All strategies together, each of which tells the chance of a light that another one drew. */
static void test_bidirectional_paths(void **state)
{
    (void)state;
    expect_alike("white", points, "estimator=bdpt:samples=16", "indirect.G", 0.01);
    expect_alike("gloss", bulbs, "estimator=bdpt:samples=16", "indirect.G", 0.01);
}

static void test_splats(void **state)
{
    (void)state;
    expect_alike("white", bulbs, "estimator=splat", "indirect.G", 0.02);
}

static void test_gloss(void **state)
{
    (void)state;
    expect_alike("gloss", bulbs, "estimator=ambient:irradiance=0", "direct.G", 0.02);
    expect_alike("gloss", bulbs, "estimator=pathtrace:samples=16", "indirect.G", 0.02);
    expect_alike("gloss", few_bulbs, "estimator=pathtrace:samples=256", "indirect.G", 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_direct_light_of_points),
        cmocka_unit_test(test_direct_light_of_bulbs),
        cmocka_unit_test(test_paths),
        cmocka_unit_test(test_bidirectional_paths),
        cmocka_unit_test(test_splats),
        cmocka_unit_test(test_gloss),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
