/* test_denoised_error.c: the error behind denoiser=regression, against path tracing, whose own
 * noise two halves tell: the layer `error` says it within a factor of 1.5 over each picture, and
 * adaptive sampling makes it less.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define MOST_OFF 1.5
#define SEEDS 4

static const char room[] =
    "psd: 1\n"
    "camera: {location: [0, 1.4, 4.5], look_at: [0, 1.1, 0], angle: 55}\n"
    "image: {width: 120, height: 80}\n"
    "materials: {white: {diffuse: 0.75}, red: {diffuse: [0.6, 0.2, 0.15]}}\n"
    "lights:\n"
    "  - spotlight: {location: [-1.2, 2.2, 1], point_at: [-2, 0, -1], radius: 40, falloff: 45, "
    "intensity: 40}\n"
    "objects:\n"
    "  - box: {corners: [[-2.5, 0, -2.5], [2.5, 2.8, 5]], material: white}\n"
    "  - box: {corners: [[0.3, 0, -1.5], [1.3, 1.2, -0.5]], rotate: [0, 25, 0], material: red}\n"
    "  - sphere: {center: [-0.8, 0.5, 0.4], radius: 0.5, material: white}\n"
    "render: {seed: %d}\n";

/* Most light has met one surface. */
static const char yard[] =
    "psd: 1\n"
    "camera: {location: [0, 2.5, 7], look_at: [0, 0.8, 0], angle: 50}\n"
    "image: {width: 120, height: 80}\n"
    "materials: {ground: {diffuse: [0.7, 0.4, 0.25]}, stone: {diffuse: 0.7}}\n"
    "lights:\n"
    "  - point: {location: [1, 3.5, 1], intensity: 40}\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -4], [-9, 0, -4]], material: ground}\n"
    "  - quad: {corners: [[-9, 0, -4], [9, 0, -4], [9, 6, -4], [-9, 6, -4]], material: stone}\n"
    "  - box: {corners: [[-2, 0, -1], [-1.5, 2.5, -0.5]], rotate: [0, 20, 0], material: stone}\n"
    "  - box: {corners: [[1, 0, -1], [1.5, 2.5, -0.5]], rotate: [0, -30, 0], material: stone}\n"
    "  - sphere: {center: [0, 0.7, 1], radius: 0.7, material: stone}\n"
    "render: {seed: %d}\n";

static struct rendering render(const char *scene, int seed, const char *const choices[])
{
    char text[2048];
    snprintf(text, sizeof text, scene, seed);
    return render_text(text, 2, choices);
}

static double mean_of_channels(const struct image *image, size_t pixel)
{
    return ((double)image_channel(image, "indirect.R")[pixel] +
            (double)image_channel(image, "indirect.G")[pixel] +
            (double)image_channel(image, "indirect.B")[pixel]) /
           3;
}

/* Two halves of the truth. */
struct truth {
    struct rendering halves[2];
};

static struct truth trace(const char *scene)
{
    static const char *const traced[] = {"estimator=pathtrace:samples=512", "bounces=all", NULL};
    return (struct truth){{render(scene, 11, traced), render(scene, 12, traced)}};
}

static void truth_release(struct truth *truth)
{
    rendering_release(&truth->halves[0]);
    rendering_release(&truth->halves[1]);
}

/* Sum of the squared errors of a picture. */
static double squared_error(const struct image *image, const struct truth *truth)
{
    double sum = 0;
    for (size_t i = 0; i < image->width * image->height; i++) {
        double value = mean_of_channels(image, i);
        sum += (value - mean_of_channels(&truth->halves[0].image, i)) *
               (value - mean_of_channels(&truth->halves[1].image, i));
    }
    return sum;
}

/* Over some seeds. */
static void expect_honest(const char *scene, const struct truth *truth, const char *estimator)
{
    const char *const choices[] = {estimator, "denoiser=regression", "bounces=all", NULL};
    double squared = 0, estimated = 0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        struct rendering test = render(scene, seed, choices);
        const float *error = image_channel(&test.image, "error");
        assert_non_null(error);
        squared += squared_error(&test.image, truth);
        for (size_t i = 0; i < test.image.width * test.image.height; i++) {
            estimated += (double)error[i] * (double)error[i];
            assert_true(error[i] >= 0);
        }
        rendering_release(&test);
    }
    assert_true(squared > 0);
    double ratio = sqrt(estimated / squared);
    print_message("%-32s estimate / error %.2f\n", estimator, ratio);
    assert_true(ratio < MOST_OFF && ratio > 1 / MOST_OFF);
}

static void test_estimators_in(const char *scene)
{
    struct truth truth = trace(scene);
    expect_honest(scene, &truth, "estimator=gather:samples=4");
    expect_honest(scene, &truth, "estimator=gather:samples=32");
    expect_honest(scene, &truth, "estimator=pathtrace:samples=16");
    truth_release(&truth);
}

static void test_room(void **state)
{
    (void)state;
    test_estimators_in(room);
}

static void test_yard(void **state)
{
    (void)state;
    test_estimators_in(yard);
}

/* Over some seeds: the squared error, and the mean of all pixels over that of the truth. */
static double error_of_seeds(const struct truth *truth, const char *estimator, double *mean)
{
    const char *const choices[] = {estimator, "denoiser=regression", "bounces=all", NULL};
    double sum = 0;
    *mean = 0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        struct rendering test = render(yard, seed, choices);
        sum += squared_error(&test.image, truth);
        *mean += mean_of_all(&test.image, "indirect.G") /
                 mean_of_all(&truth->halves[0].image, "indirect.G") / SEEDS;
        rendering_release(&test);
    }
    return sum;
}

/* What a first round finds decides how many samples follow, which must not bias their mean. */
static void test_adaptive_sampling(void **state)
{
    (void)state;
    double mean, even_mean;
    struct truth truth = trace(yard);
    double adaptive = error_of_seeds(&truth, "estimator=gather:samples=16", &mean);
    double even = error_of_seeds(&truth, "estimator=gather:samples=16,adaptive=no", &even_mean);
    print_message("adaptive / even error %.2f, means %.4f and %.4f\n", sqrt(adaptive / even), mean,
                  even_mean);
    assert_true(adaptive < 0.95 * even);
    assert_true(fabs(mean - even_mean) < 0.003);
    truth_release(&truth);
}

/* A denoiser that estimates nothing makes no layer of zeros. */
static void test_no_estimate_no_layer(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=ambient", "denoiser=bilateral", NULL};
    struct rendering rendering = render(yard, 1, choices);
    assert_null(image_channel(&rendering.image, "error"));
    rendering_release(&rendering);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_room),
        cmocka_unit_test(test_yard),
        cmocka_unit_test(test_adaptive_sampling),
        cmocka_unit_test(test_no_estimate_no_layer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
