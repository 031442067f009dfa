/* test_guided_gather.c: gather rays drawn where those before them found light, and how both are
 * combined.
 *
 * A wall that no lamp reaches sees a small lit patch of the floor: by the cosine one ray in ten
 * finds it.
 */
#include "support/lit_floor.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define WIDTH 96
#define HEIGHT 64
#define SEEDS 4

static const char scene[] = LIT_FLOOR("location: [0, 1.5, 4], look_at: [0, 1.3, 0], angle: 30", "");

static struct rendering render_by(const char *estimator, int seed)
{
    const char *const strategies[] = {estimator, "denoiser=none", NULL};
    char text[2048];
    snprintf(text, sizeof text, "%srender: {bounces: 1, passes: 1, seed: %d}\n", scene, seed);
    return render_text(text, 2, strategies);
}

static double grain_by(const char *estimator)
{
    struct rendering rendering = render_by(estimator, 1);
    double grain = grain_of(&rendering.image, "indirect.G", 1, 1, WIDTH - 2, HEIGHT - 2);
    rendering_release(&rendering);
    return grain;
}

/* Photons tell the first rays where the patch is, and these tell the others. */
static void test_guided_rays_count_by_their_pdf(void **state)
{
    (void)state;
    double by_cosine = grain_by("estimator=pathtrace:samples=1");
    double by_photons = grain_by("estimator=gather:samples=1");
    double four = grain_by("estimator=pathtrace:samples=4");
    double two_and_two = grain_by("estimator=gather:samples=4,adaptive=no");
    double both = grain_by("estimator=gather:samples=8,adaptive=no");
    double shared_out = grain_by("estimator=gather:samples=8,adaptive=yes");
    print_message("noise %.3f, by photons %.3f; of four %.3f, guided %.3f, of eight %.3f, "
                  "shared out %.3f\n",
                  by_cosine, by_photons, four, two_and_two, both, shared_out);
    assert_true(four > 1.0);
    assert_true(by_photons < 0.65 * by_cosine);
    assert_true(two_and_two < 0.5 * four);
    assert_true(both < 0.32 * four);
    assert_true(shared_out < 0.32 * four);
}

/* A ball across the edge of its shade, in one tile: the patch of floor that lights it lies below
 * the horizon of half of the pixels. */
static const char ball[] =
    "psd: 1\n"
    "camera: {location: [0, 2, 6], look_at: [0.25, 1.75, 0.93], angle: 8}\n"
    "image: {width: 32, height: 32}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights: [spotlight: {location: [2, 1, 0], point_at: [2, 0, 0], radius: 12, falloff: 14, "
    "intensity: 100}]\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: white}\n"
    "  - sphere: {center: [0, 2, 0], radius: 1, material: white}\n"
    "render: {bounces: 1, passes: 1}\n";

/* Rays of a guide that faced as the first pixel does would find all light of some pixels by the
 * cosine alone. */
static void test_guides_of_bent_surfaces(void **state)
{
    (void)state;
    static const char *const strategies[] = {"estimator=gather:samples=64", "denoiser=none", NULL};
    struct rendering rendering = render_text(ball, 2, strategies);
    double grain = grain_of(&rendering.image, "indirect.G", 1, 1, 30, 30);
    print_message("noise at the edge of a ball's shade: %.3f\n", grain);
    assert_true(grain < 1.6);
    rendering_release(&rendering);
}

static double mean_by(const char *estimator, int seed)
{
    struct rendering rendering = render_by(estimator, seed);
    double mean = mean_of_all(&rendering.image, "indirect.G");
    rendering_release(&rendering);
    return mean;
}

/* Weights that follow from what the weighed rays found must not darken or brighten the light. */
static void test_weights_keep_the_mean(void **state)
{
    (void)state;
    double reference = mean_by("estimator=pathtrace:samples=512", 100);
    static const char *const estimators[] = {"estimator=gather:samples=4",
                                             "estimator=gather:samples=8",
                                             "estimator=gather:samples=32,adaptive=no"};
    for (size_t i = 0; i < sizeof estimators / sizeof estimators[0]; i++) {
        double mean = 0;
        for (int seed = 1; seed <= SEEDS; seed++)
            mean += mean_by(estimators[i], seed) / SEEDS;
        print_message("%s: %.4f of the light\n", estimators[i], mean / reference);
        assert_true(fabs(mean / reference - 1) < 5e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_guided_rays_count_by_their_pdf),
        cmocka_unit_test(test_guides_of_bent_surfaces),
        cmocka_unit_test(test_weights_keep_the_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
