/* test_strategies.c: what visibilities, normalizations and denoisers are chosen for, seen in small
 * pictures. For filters see test_filters.c. */
#include "support/render_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define PHOTONS "injection=photon:count=20000"

/* A floor lit by way of the ceiling alone, and a plate close above it; seen from under the plate's
 * height, so that the floor below the plate is in the picture. */
static const char plate_text[] =
    "psd: 1\n"
    "camera: {location: [0, 0.45, 6], look_at: [0, 0.15, 0], angle: 50}\n"
    "image: {width: 96, height: 54}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights:\n"
    "  - spotlight: {location: [0, 3, 0], point_at: [0, 4, 0], radius: 60, falloff: 60,\n"
    "                intensity: 100}\n"
    "objects:\n"
    "  - quad: {corners: [[-5, 0, -5], [5, 0, -5], [5, 0, 5], [-5, 0, 5]], material: white}\n"
    "  - quad: {corners: [[-5, 4, -5], [5, 4, -5], [5, 4, 5], [-5, 4, 5]], material: white}\n"
    "  - box: {corners: [[-1.5, 0.5, -1.5], [1.5, 0.6, 1.5]], material: white}\n";

static char *cornell;

static int read_cornell(void **state)
{
    (void)state;
    cornell = cornell_text(96, 54);
    return 0;
}

static int release_cornell(void **state)
{
    (void)state;
    free(cornell);
    return 0;
}

/* The picture with up to three choices laid over the small number of photons. */
static struct rendering render(const char *text, const char *a, const char *b, const char *c)
{
    const char *const choices[] = {PHOTONS, a, b, c, NULL};
    return render_text(text, 2, choices);
}

struct moments {
    double mean, deviation, largest_step; /* between neighbours in a row */
    size_t count;
};

/* Of the indirect light of the pixels that see a surface, and have weight. */
static struct moments moments_of(const struct image *image)
{
    const float *green = image_channel(image, "indirect.G"), *z = image_channel(image, "Z");
    const float *weight = image_channel(image, "weight");
    struct moments moments = {0};
    double sum_of_squares = 0;
    for (size_t i = 0; i < image->width * image->height; i++) {
        bool counts = isfinite(z[i]) && weight[i] > 0;
        if (counts) {
            moments.mean += green[i];
            sum_of_squares += (double)green[i] * green[i];
            moments.count++;
        }
        if (counts && i % image->width > 0)
            moments.largest_step = fmax(moments.largest_step, fabsf(green[i] - green[i - 1]));
    }
    assert_true(moments.count > 0);
    moments.mean /= (double)moments.count;
    moments.deviation = sqrt(sum_of_squares / (double)moments.count - moments.mean * moments.mean);
    return moments;
}

static struct moments measure(const char *text, const char *a, const char *b, const char *c)
{
    struct rendering rendering = render(text, a, b, c);
    struct moments moments = moments_of(&rendering.image);
    rendering_release(&rendering);
    return moments;
}

/* Mean indirect light of the floor inside, or outside, of |x|, |z| < reach. */
static double floor_light(const struct image *image, double reach, bool inside)
{
    const float *x = image_channel(image, "P.X"), *y = image_channel(image, "P.Y");
    const float *z = image_channel(image, "P.Z"), *green = image_channel(image, "indirect.G");
    const float *depth = image_channel(image, "Z");
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < image->width * image->height; i++)
        if (isfinite(depth[i]) && fabsf(y[i]) < 1e-3f && fabsf(x[i]) < 3 && fabsf(z[i]) < 3 &&
            (fmaxf(fabsf(x[i]), fabsf(z[i])) < reach) == inside) {
            sum += green[i];
            count++;
        }
    assert_true(count > 50);
    return sum / (double)count;
}

struct floor_pair {
    double under, open;
};

static struct floor_pair plate_floor(const char *visibility)
{
    struct rendering rendering = render(plate_text, visibility, NULL, NULL);
    struct floor_pair pair = {floor_light(&rendering.image, 0.9, true),
                              floor_light(&rendering.image, 2.2, false)};
    rendering_release(&rendering);
    print_message("%s: floor under the plate %.3f, in the open %.3f\n", visibility, pair.under,
                  pair.open);
    return pair;
}

static void test_shadow_maps_keep_light_from_under_a_plate(void **state)
{
    (void)state;
    struct floor_pair none = plate_floor("visibility=none:radius=0.6");
    struct floor_pair map = plate_floor("visibility=shadowmap:radius=0.6,step_back=auto");
    struct floor_pair full = plate_floor("visibility=shadowmap:radius=0.6,step_back=full");
    assert_true(map.under < 0.2 * none.under);
    assert_true(full.under < 0.2 * none.under);
    assert_true(none.under > 0.5 * none.open); /* it leaks right through */
    assert_true(fabs(map.open / none.open - 1) < 0.05);
    assert_true(fabs(full.open / none.open - 1) < 0.05);
}

static void test_light_leaks_without_visibility(void **state)
{
    (void)state;
    struct moments none = measure(cornell, "visibility=none:radius=80", NULL, NULL);
    struct moments map =
        measure(cornell, "visibility=shadowmap:radius=80,step_back=auto", NULL, NULL);
    print_message("Cornell box: none / shadowmap %.4f\n", none.mean / map.mean);
    assert_true(none.mean > 1.02 * map.mean);
}

/* --- normalizations --- */

static void test_weight_keeps_the_mean_and_flattens(void **state)
{
    (void)state;
    struct moments density = measure(cornell, "normalization=density", NULL, NULL);
    struct moments weight = measure(cornell, "normalization=weight:exposure=auto", NULL, NULL);
    assert_int_equal(density.count, weight.count);
    print_message("density: mean %.4f, deviation / mean %.3f; weight: %.4f, %.3f\n", density.mean,
                  density.deviation / density.mean, weight.mean, weight.deviation / weight.mean);
    assert_true(weight.deviation / weight.mean < 0.9 * density.deviation / density.mean);
}

/* Mean of the three colours over the pixels with weight, after two passes. */
static double mean_with_weight(const char *normalization)
{
    char text[16384];
    snprintf(text, sizeof text, "%s\n  passes: 2\n", cornell); /* its section `render` is last */
    struct rendering rendering = render(text, normalization, NULL, NULL);
    static const char *const names[3] = {"indirect.R", "indirect.G", "indirect.B"};
    const float *weight = image_channel(&rendering.image, "weight");
    double sum = 0;
    size_t count = 0;
    for (int c = 0; c < 3; c++) {
        const float *samples = image_channel(&rendering.image, names[c]);
        for (size_t i = 0; i < rendering.image.width * rendering.image.height; i++)
            if (weight[i] > 0) {
                sum += samples[i];
                count++;
            }
    }
    rendering_release(&rendering);
    return sum / (double)count;
}

static void test_automatic_exposure_matches_density(void **state)
{
    (void)state;
    double ratio = mean_with_weight("normalization=weight:exposure=auto") /
                   mean_with_weight("normalization=density");
    assert_true(fabs(ratio - 1) < 1e-3);
}

static void test_exposure_is_a_factor(void **state)
{
    (void)state;
    struct rendering one = render(cornell, "normalization=weight:exposure=1", NULL, NULL);
    struct rendering two = render(cornell, "normalization=weight:exposure=2", NULL, NULL);
    const float *a = image_channel(&one.image, "indirect.R");
    const float *b = image_channel(&two.image, "indirect.R");
    for (size_t i = 0; i < one.image.width * one.image.height; i++)
        assert_true(fabsf(b[i] - 2 * a[i]) <= 1e-6f * b[i]);
    assert_true(mean_of_all(&one.image, "indirect.R") > 0);
    rendering_release(&one);
    rendering_release(&two);
}

/* --- denoisers --- */

static void test_gaussian_denoiser_smooths(void **state)
{
    (void)state;
    static const char *const choices[] = {"denoiser=none", "denoiser=gaussian:size=3x3",
                                          "denoiser=gaussian:size=5x5",
                                          "denoiser=gaussian:size=9x9"};
    struct moments before = {0};
    for (int i = 0; i < 4; i++) {
        struct moments moments =
            measure(cornell, choices[i], "visibility=none:radius=15,bandwidth_scale=0", NULL);
        print_message("%s: mean %.4f, deviation %.4f\n", choices[i], moments.mean,
                      moments.deviation);
        if (i > 0) {
            assert_true(fabs(moments.mean / before.mean - 1) < 0.01);
            assert_true(moments.deviation < 0.99 * before.deviation);
            assert_true(moments.largest_step < before.largest_step);
        }
        before = moments;
    }
}

/* The direct light and the geometry are not blurred. */
static void test_denoiser_leaves_the_rest(void **state)
{
    (void)state;
    static const char *const names[] = {"direct.R", "albedo.G", "N.X", "Z", "weight"};
    struct rendering sharp = render(cornell, "denoiser=none", NULL, NULL);
    struct rendering soft = render(cornell, "denoiser=gaussian", NULL, NULL);
    size_t bytes = sharp.image.width * sharp.image.height * sizeof(float);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_memory_equal(image_channel(&sharp.image, names[i]),
                            image_channel(&soft.image, names[i]), bytes);
    assert_memory_not_equal(image_channel(&sharp.image, "indirect.G"),
                            image_channel(&soft.image, "indirect.G"), bytes);
    rendering_release(&sharp);
    rendering_release(&soft);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shadow_maps_keep_light_from_under_a_plate),
        cmocka_unit_test(test_light_leaks_without_visibility),
        cmocka_unit_test(test_weight_keeps_the_mean_and_flattens),
        cmocka_unit_test(test_automatic_exposure_matches_density),
        cmocka_unit_test(test_exposure_is_a_factor),
        cmocka_unit_test(test_gaussian_denoiser_smooths),
        cmocka_unit_test(test_denoiser_leaves_the_rest),
    };
    return cmocka_run_group_tests(tests, read_cornell, release_cornell);
}
