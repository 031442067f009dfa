/* test_skylight.c: a room that the sky lights through a window, by the final gather, whose rays
 * take the sky's light where they land out of a cache; one with a sun besides, and with counted
 * bounces; and a wall before red grooves between white beams.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define WIDTH 96
#define HEIGHT 64

/* A box of 4 x 3 x 6 without its near wall's middle: the window, behind the camera, a fifth of that
 * wall. */
#define ROOM                                                                                       \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 1.5, 2.5], look_at: [0, 1.2, -3], angle: 75}\n"                        \
    "image: {width: 96, height: 64}\n"                                                             \
    "materials: {white: {diffuse: 0.7}, satin: {glossy: {diffuse: 0.5, specular: 0.2, roughness: " \
    "0.4}}}\n"                                                                                     \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, 0, 3], [2, 0, 3], [2, 0, -3], [-2, 0, -3]], material: white}\n"     \
    "  - quad: {corners: [[-2, 3, 3], [-2, 3, -3], [2, 3, -3], [2, 3, 3]], material: white}\n"     \
    "  - quad: {corners: [[-2, 0, 3], [-2, 0, -3], [-2, 3, -3], [-2, 3, 3]], material: satin}\n"   \
    "  - quad: {corners: [[2, 0, 3], [2, 3, 3], [2, 3, -3], [2, 0, -3]], material: white}\n"       \
    "  - quad: {corners: [[-2, 0, -3], [2, 0, -3], [2, 3, -3], [-2, 3, -3]], material: white}\n"   \
    "  - quad: {corners: [[-2, 0, 3], [-2, 3, 3], [-0.8, 3, 3], [-0.8, 0, 3]], material: white}\n" \
    "  - quad: {corners: [[0.8, 0, 3], [0.8, 3, 3], [2, 3, 3], [2, 0, 3]], material: white}\n"     \
    "  - quad: {corners: [[-0.8, 0, 3], [-0.8, 1.2, 3], [0.8, 1.2, 3], [0.8, 0, 3]], material: "   \
    "white}\n"                                                                                     \
    "  - quad: {corners: [[-0.8, 2.6, 3], [-0.8, 3, 3], [0.8, 3, 3], [0.8, 2.6, 3]], material: "   \
    "white}\n"                                                                                     \
    "  - box: {corners: [[-0.6, 0, -2], [0.6, 1, -1]], material: satin}\n"

#define SKY "lights:\n  - sky: {radiance: 1}\n"
#define SUN "  - sun: {direction: [0.2, -0.5, -1], angle: 1, irradiance: 20}\n"

static struct rendering render_by(const char *scene, const char *estimator, const char *bounces,
                                  int seed)
{
    const char *const strategies[] = {estimator, "denoiser=none", NULL};
    char text[8192];
    snprintf(text, sizeof text, "%srender: {bounces: %s, passes: 1, seed: %d}\n", scene, bounces,
             seed);
    return render_text(text, 2, strategies);
}

static double mean_by(const char *scene, const char *estimator, const char *bounces, int seeds)
{
    double mean = 0;
    for (int seed = 1; seed <= seeds; seed++) {
        struct rendering rendering = render_by(scene, estimator, bounces, seed);
        mean += mean_of_all(&rendering.image, "indirect.G") / seeds;
        rendering_release(&rendering);
    }
    return mean;
}

static double grain_by(const char *scene, const char *estimator)
{
    struct rendering rendering = render_by(scene, estimator, "all", 1);
    double grain = grain_of(&rendering.image, "indirect.G", 1, 1, WIDTH - 2, HEIGHT - 2);
    rendering_release(&rendering);
    return grain;
}

/* With surfels=0 rays ask for the sky where they land, and their paths go on to their ends. */
static void test_light_is_that_of_path_tracing(void **state)
{
    (void)state;
    static const struct {
        const char *what, *scene, *bounces;
    } rooms[] = {
        {"sky, one bounce", ROOM SKY, "1"},
        {"sky, all bounces", ROOM SKY, "all"},
        {"sky and sun, two bounces", ROOM SKY SUN, "2"},
    };
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        const char *scene = rooms[i].scene, *bounces = rooms[i].bounces;
        double reference = mean_by(scene, "estimator=pathtrace:samples=1024", bounces, 1);
        double cached = mean_by(scene, "estimator=gather:samples=16", bounces, 6);
        double asked = mean_by(scene, "estimator=gather:samples=16,surfels=0", bounces, 6);
        print_message("%s: %.4f of the light, %.4f without surfels\n", rooms[i].what,
                      cached / reference, asked / reference);
        assert_true(fabs(cached / reference - 1) < 0.015);
        assert_true(fabs(asked / reference - 1) < 0.015);
    }
}

/* A wall under the sky, and before it a floor of white beams, with red grooves between them, which
 * get a part of the sky alone. */
static const char *grooves(void)
{
    static char text[4096];
    int length = snprintf(text, sizeof text,
                          "psd: 1\n"
                          "camera: {location: [0, 2, 0], look_at: [0, 2, -5], angle: 60}\n"
                          "image: {width: 96, height: 64}\n"
                          "materials: {white: {diffuse: 0.7}, red: {diffuse: [0.9, 0, 0]}}\n" SKY
                          "objects:\n"
                          "  - quad: {corners: [[-9, -2, -5], [9, -2, -5], [9, 6, -5], [-9, 6, "
                          "-5]], material: white}\n"
                          "  - quad: {corners: [[-9, -0.5, 6], [9, -0.5, 6], [9, -0.5, -5], [-9, "
                          "-0.5, -5]], material: red}\n");
    for (int i = -15; i < 15; i++)
        length +=
            snprintf(text + length, sizeof text - (size_t)length,
                     "  - box: {corners: [[%.1f, -0.5, -5], [%.1f, 0, 6]], material: white}\n",
                     0.6 * i, 0.6 * i + 0.3);
    return text;
}

/* What is red is dark here: with the mean light of both, the wall would get 1.4 times as much of
 * it. */
static void test_grooves_have_light_of_their_own(void **state)
{
    (void)state;
    double mean[2] = {0, 0};
    static const char *const estimators[] = {"estimator=pathtrace:samples=512",
                                             "estimator=gather:samples=16"};
    for (int i = 0; i < 2; i++) {
        struct rendering rendering = render_by(grooves(), estimators[i], "1", 1);
        mean[i] = mean_of_all(&rendering.image, "indirect.R") -
                  mean_of_all(&rendering.image, "indirect.G");
        rendering_release(&rendering);
    }
    print_message("red of grooves: %.4f of the light\n", mean[1] / mean[0]);
    assert_true(fabs(mean[1] / mean[0] - 1) < 0.05);
}

static void test_noise(void **state)
{
    (void)state;
    double cached = grain_by(ROOM SKY, "estimator=gather:samples=8");
    double asked = grain_by(ROOM SKY, "estimator=gather:samples=8,surfels=0");
    print_message("noise %.3f, without surfels %.3f\n", cached, asked);
    assert_true(cached < 0.6 * asked);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_is_that_of_path_tracing),
        cmocka_unit_test(test_grooves_have_light_of_their_own),
        cmocka_unit_test(test_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
