/* test_progressive.c: what passes do to photon mapping. With radii that stay, its error falls to a
 * floor, the bias; with those of sppm it goes on falling, at a rate near passes^(-1/3) (Knaus and
 * Zwicker 2011). Against two halves by path tracing.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/run_tests.h"

/* Nothing but smooth light: bias and noise are those of theory. */
static const char sphere[] = "psd: 1\n"
                             "camera: {location: [0, 0, 0], look_at: [1, 0.3, 0.2], angle: 100}\n"
                             "image: {width: 48, height: 48}\n"
                             "materials: {wall: {diffuse: 0.6}}\n"
                             "lights: [{point: {location: [1.2, 0.4, 0.2], intensity: 4}}]\n"
                             "objects: [{sphere: {center: [0, 0, 0], radius: 2, material: wall}}]\n"
                             "render: {seed: %d, passes: %d}\n";

/* At its edges radii reach past the surfaces: a bias over a strip as wide as the radius, whose root
 * mean square falls with the root of the radius alone. */
static const char room[] =
    "psd: 1\n"
    "camera: {location: [0, 1.4, 4.5], look_at: [0, 1.1, 0], angle: 55}\n"
    "image: {width: 72, height: 48}\n"
    "materials: {white: {diffuse: 0.75}, red: {diffuse: [0.6, 0.2, 0.15]}}\n"
    "lights:\n"
    "  - spotlight: {location: [-1.2, 2.2, 1], point_at: [-2, 0, -1], radius: 40, falloff: 45, "
    "intensity: 40}\n"
    "objects:\n"
    "  - box: {corners: [[-2.5, 0, -2.5], [2.5, 2.8, 5]], material: white}\n"
    "  - sphere: {center: [-0.8, 0.5, 0.4], radius: 0.5, material: white}\n"
    "render: {seed: %d, passes: %d}\n";

static struct rendering render(const char *scene, int seed, int passes, const char *estimator)
{
    const char *const choices[] = {estimator, "injection=photon:count=3000", "bounces=all", NULL};
    char text[2048];
    snprintf(text, sizeof text, scene, seed, passes);
    return render_text(text, 2, choices);
}

#define SAMPLES 512

/* At the same points of the pixels as a picture of so many passes. */
static void trace(const char *scene, int passes, struct rendering halves[2])
{
    char estimator[64];
    snprintf(estimator, sizeof estimator, "estimator=pathtrace:samples=%d", 1 + SAMPLES / passes);
    for (int i = 0; i < 2; i++)
        halves[i] = render(scene, 11 + i, passes, estimator);
}

/* Relative, of the green indirect light, where the halves' own noise falls out. */
static double error_of(const struct image *image, const struct rendering halves[2])
{
    const float *a = image_channel(&halves[0].image, "indirect.G");
    const float *b = image_channel(&halves[1].image, "indirect.G");
    const float *test = image_channel(image, "indirect.G");
    double squared = 0, truth = 0;
    for (size_t i = 0; i < image->width * image->height; i++) {
        squared += ((double)test[i] - (double)a[i]) * ((double)test[i] - (double)b[i]);
        truth += (double)a[i] * (double)b[i];
    }
    return sqrt(fmax(squared, 0) / truth);
}

static double error_after(const char *scene, int passes, const char *estimator,
                          const struct rendering halves[2])
{
    struct rendering test = render(scene, 1, passes, estimator);
    double error = error_of(&test.image, halves);
    print_message("%3d passes, %-36s error %.2f %%, mean / truth %.4f\n", passes, estimator,
                  100 * error,
                  2 * mean_of_all(&test.image, "indirect.G") /
                      (mean_of_all(&halves[0].image, "indirect.G") +
                       mean_of_all(&halves[1].image, "indirect.G")));
    rendering_release(&test);
    return error;
}

static double rate_of(const char *scene, int few, int many, const char *estimator,
                      const struct rendering halves[2])
{
    double first = error_after(scene, few, estimator, halves);
    double last = error_after(scene, many, estimator, halves);
    double rate = log(last / first) / log((double)many / few);
    print_message("rate: %.2f\n", rate);
    return rate;
}

static void expect_no_floor(int few, int many)
{
    static const char fixed[] = "estimator=photonmap:neighbours=50", shrinks[] = "estimator=sppm";
    struct rendering in_sphere[2], in_room[2];
    trace(sphere, many, in_sphere);
    trace(room, many, in_room);
    double rate = rate_of(sphere, few, many, shrinks, in_sphere);
    assert_true(rate < -0.25 && rate > -0.47);
    rate = rate_of(room, few, many, shrinks, in_room);
    assert_true(rate < -0.12);
    assert_true(rate < rate_of(room, few, many, fixed, in_room) - 0.05);
    for (int i = 0; i < 2; i++) {
        rendering_release(&in_sphere[i]);
        rendering_release(&in_room[i]);
    }
}

static void test_some_passes(void **state)
{
    (void)state;
    expect_no_floor(4, 32);
}

static void test_many_passes(void **state)
{
    (void)state;
    expect_no_floor(25, 200);
}

/* A pass is that of its number, whoever rendered those before it: radii are not those of a
 * history. */
static void test_first_pass_is_photon_mapping(void **state)
{
    (void)state;
    struct rendering sppm = render(room, 1, 1, "estimator=sppm:neighbours=40");
    struct rendering map = render(room, 1, 1, "estimator=photonmap:neighbours=40");
    expect_same_image(&sppm.image, &map.image);
    rendering_release(&sppm);
    rendering_release(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_first_pass_is_photon_mapping),
        cmocka_unit_test(test_some_passes),
        SLOW_TEST(test_many_passes),
    };
    return RUN_TESTS(tests);
}
