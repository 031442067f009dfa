/* test_interleave.c: splats that light interleaved pixels, end to end: as bright as splats that
 * light all of them, and as independent of threads and batches. */
#include "support/render_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 160
#define HEIGHT 90
#define PHOTONS "injection=photon:count=60000"
#define SHADOW_MAPS "visibility=shadowmap:radius=40,resolution=4"

static char *cornell, *cornell_in_passes;

static int read_cornell(void **state)
{
    (void)state;
    cornell = cornell_text(WIDTH, HEIGHT);
    size_t size = strlen(cornell) + 32;
    cornell_in_passes = malloc(size);
    assert_non_null(cornell_in_passes);
    snprintf(cornell_in_passes, size, "%s\n  passes: 2\n", cornell);
    return 0;
}

static int release_cornell(void **state)
{
    (void)state;
    free(cornell);
    free(cornell_in_passes);
    return 0;
}

static struct rendering render_by(const char *visibility, const char *text, const char *injection,
                                  int interleave)
{
    char estimator[64];
    const char *const choices[] = {injection, visibility, estimator, NULL};
    snprintf(estimator, sizeof estimator, "estimator=splat:interleave=%d", interleave);
    return render_text(text, 2, choices);
}

static struct rendering render(const char *text, const char *injection, int interleave)
{
    return render_by(SHADOW_MAPS, text, injection, interleave);
}

static void expect_finite(const struct image *image, const char *channel)
{
    const float *samples = image_channel(image, channel);
    assert_non_null(samples);
    for (size_t i = 0; i < image->width * image->height; i++)
        if (!isfinite(samples[i]) || samples[i] < 0)
            fail_msg("%s of pixel %zu is %g", channel, i, (double)samples[i]);
}

/* The mean of the indirect layer, whose samples are numbers. */
struct mean {
    double r, g, b;
};

static struct mean indirect(const char *text, const char *injection, int interleave)
{
    struct rendering rendering = render(text, injection, interleave);
    const struct image *image = &rendering.image;
    expect_finite(image, "indirect.R");
    expect_finite(image, "indirect.G");
    expect_finite(image, "indirect.B");
    struct mean mean = {mean_of_all(image, "indirect.R"), mean_of_all(image, "indirect.G"),
                        mean_of_all(image, "indirect.B")};
    rendering_release(&rendering);
    return mean;
}

static void expect_as_bright(const char *what, struct mean mean, struct mean expected,
                             double tolerance)
{
    double r = mean.r / expected.r, g = mean.g / expected.g, b = mean.b / expected.b;
    assert_true(expected.r > 0 && expected.g > 0 && expected.b > 0);
    print_message("%s: %.4f, %.4f, %.4f times as bright\n", what, r, g, b);
    assert_true(fabs(r - 1) < tolerance && fabs(g - 1) < tolerance && fabs(b - 1) < tolerance);
}

static void test_interleaving_keeps_the_brightness(void **state)
{
    (void)state;
    struct mean all = indirect(cornell, PHOTONS, 1);
    expect_as_bright("interleave 2", indirect(cornell, PHOTONS, 2), all, 0.01);
    expect_as_bright("interleave 4", indirect(cornell, PHOTONS, 4), all, 0.015);
    expect_as_bright("interleave 8", indirect(cornell, PHOTONS, 8), all, 0.025);
}

/* Each pass gives the subsets other paths. */
static void test_two_passes_keep_the_brightness(void **state)
{
    (void)state;
    struct mean all = indirect(cornell_in_passes, PHOTONS, 1);
    expect_as_bright("two passes", indirect(cornell_in_passes, PHOTONS, 4), all, 0.015);
}

/* Their photons are ordered like pixels and voxels are, so that a subset's might lie all in one
 * place. */
static void test_other_injections_keep_the_brightness(void **state)
{
    (void)state;
    static const char *const injections[] = {"injection=voxel", "injection=rsm"};
    for (size_t i = 0; i < 2; i++)
        expect_as_bright(injections[i], indirect(cornell, injections[i], 4),
                         indirect(cornell, injections[i], 1), 0.015);
}

/* It does interleave: a splat lights the sixteenth part of its pixels, and fewer are tested. Of one
 * size all, since those that follow the distance are no smaller than 4 pixels. */
static void test_interleaving_saves_tests(void **state)
{
    (void)state;
    struct rendering all = render_by(SHADOW_MAPS ",bandwidth_scale=0", cornell, PHOTONS, 1);
    struct rendering some = render_by(SHADOW_MAPS ",bandwidth_scale=0", cornell, PHOTONS, 4);
    double tests = statistics_counter(&some.statistics, "pixel-splat tests") /
                   statistics_counter(&all.statistics, "pixel-splat tests");
    double lit = statistics_counter(&some.statistics, "pixel-splat tests with weight") /
                 statistics_counter(&all.statistics, "pixel-splat tests with weight");
    print_message("interleave 4: %.4f of the tests, %.4f of them with weight\n", tests, lit);
    assert_true(fabs(16 * lit - 1) < 0.03);
    assert_true(tests >= lit && tests < 0.5);
    rendering_release(&all);
    rendering_release(&some);
}

static void test_same_picture_for_all_threads_and_batches(void **state)
{
    (void)state;
    static const size_t batches[] = {17, 4096};
    const char *const choices[] = {"injection=photon:count=3000", "bounces=3", SHADOW_MAPS,
                                   "estimator=splat:interleave=4", NULL};
    struct rendering first = render_text(cornell_in_passes, 1, choices);
    assert_true(mean_of_all(&first.image, "indirect.G") > 0);
    for (uint32_t threads = 1; threads <= 3; threads += 2)
        for (size_t i = 0; i < 2; i++) {
            struct rendering other =
                render_text_in_batches(cornell_in_passes, threads, batches[i], choices);
            expect_same_image(&first.image, &other.image);
            rendering_release(&other);
        }
    rendering_release(&first);
}

/* Most subsets have no pixel. */
static void test_pictures_smaller_than_the_pattern(void **state)
{
    (void)state;
    char *text = cornell_text(5, 3);
    struct mean all = indirect(text, PHOTONS, 1), some = indirect(text, PHOTONS, 8);
    expect_as_bright("5x3 pixels", some, all, 0.2); /* a 64th of the photons lights each */
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_interleaving_keeps_the_brightness),
        cmocka_unit_test(test_two_passes_keep_the_brightness),
        cmocka_unit_test(test_other_injections_keep_the_brightness),
        cmocka_unit_test(test_interleaving_saves_tests),
        cmocka_unit_test(test_same_picture_for_all_threads_and_batches),
        cmocka_unit_test(test_pictures_smaller_than_the_pattern),
    };
    return cmocka_run_group_tests(tests, read_cornell, release_cornell);
}
