/* test_pipeline.c: the driver: photons pass through, dark pixels are filled and counted, layers
 * join, and the picture depends on neither threads nor batches. */
#include "short_range/short_range_light.h"
#include "support/render_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 64
#define HEIGHT 36

static char *cornell;

static int read_cornell(void **state)
{
    (void)state;
    cornell = cornell_text(WIDTH, HEIGHT);
    return 0;
}

static int release_cornell(void **state)
{
    (void)state;
    free(cornell);
    return 0;
}

/* The Cornell box with more lines in its section `render`, which comes last. The caller frees it.
 */
static char *cornell_with(const char *lines)
{
    size_t size = strlen(cornell) + strlen(lines) + 8;
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "%s\n  %s\n", cornell, lines);
    return text;
}

static struct rendering render(const char *text, const char *a, const char *b)
{
    const char *const choices[] = {a, b, NULL};
    return render_text(text, 2, choices);
}

static void test_no_stratification_passes_photons_through(void **state)
{
    (void)state;
    struct rendering rendering =
        render(cornell, "injection=photon:count=5000", "stratification=none");
    double injected = statistics_counter(&rendering.statistics, "photons injected");
    assert_true(injected > 3500 && injected < 4500); /* some photons leave through the front */
    assert_true(statistics_counter(&rendering.statistics, "photons") == injected);
    assert_true(statistics_counter(&rendering.statistics, "splats") == injected);
    rendering_release(&rendering);
}

/* More bounces make more photons and more light. */
static void test_bounces_add_photons(void **state)
{
    (void)state;
    struct rendering one = render(cornell, "injection=photon:count=5000", "bounces=1");
    struct rendering three =
        render(cornell, "injection=photon:count=5000,roulette=1000", "bounces=3");
    assert_true(statistics_counter(&three.statistics, "photons") >
                2 * statistics_counter(&one.statistics, "photons"));
    assert_true(mean_of_all(&three.image, "indirect.R") > mean_of_all(&one.image, "indirect.R"));
    rendering_release(&one);
    rendering_release(&three);
}

/* A few photons leave nearly all pixels without weight: they take the ambient colour, but only
 * where there is a surface. */
static void test_ambient_fills_dark_pixels(void **state)
{
    (void)state;
    char *text = cornell_with("ambient: [1.5, 2.5, 3.5]");
    struct rendering rendering =
        render(text, "injection=photon:count=8", "estimator=splat:gather_rays=0");
    const struct image *image = &rendering.image;
    const float *weight = image_channel(image, "weight"), *z = image_channel(image, "Z");
    const float *red = image_channel(image, "indirect.R");
    const float *blue = image_channel(image, "indirect.B");
    size_t dark = 0, nothing = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        if (weight[i] > 0)
            continue;
        dark += isfinite(z[i]) != 0;
        nothing += !isfinite(z[i]);
        assert_true(red[i] == (isfinite(z[i]) ? 1.5f : 0.0f));
        assert_true(blue[i] == (isfinite(z[i]) ? 3.5f : 0.0f));
    }
    print_message("%zu pixels without weight, %zu see nothing\n", dark, nothing);
    assert_true(dark > 100 && nothing > 100 && dark + nothing < WIDTH * HEIGHT);
    assert_true(statistics_counter(&rendering.statistics, "pixels without weight") == (double)dark);
    rendering_release(&rendering);
    free(text);
}

/* R, G, B are the direct plus the indirect light, times its exposure. */
static void test_layers_join(void **state)
{
    (void)state;
    char *text = cornell_with("indirect_exposure: 3");
    struct rendering rendering = render(text, "injection=photon:count=5000", NULL);
    const float *sum = image_channel(&rendering.image, "G");
    const float *direct = image_channel(&rendering.image, "direct.G");
    const float *indirect = image_channel(&rendering.image, "indirect.G");
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(fabsf(sum[i] - direct[i] - 3 * indirect[i]) <= 1e-5f * sum[i]);
    assert_true(mean_of_all(&rendering.image, "direct.G") > 0);
    assert_true(mean_of_all(&rendering.image, "indirect.G") > 0);
    rendering_release(&rendering);
    free(text);
}

/* A render is the mean of its passes: more of them make no more light. */
static void test_passes_keep_the_brightness(void **state)
{
    (void)state;
    char *four_text = cornell_with("passes: 4"), *eight_text = cornell_with("passes: 8");
    struct rendering four = render(four_text, "injection=photon:count=5000", NULL);
    struct rendering eight = render(eight_text, "injection=photon:count=2500", NULL);
    double ratio = mean_of_all(&eight.image, "indirect.R") / mean_of_all(&four.image, "indirect.R");
    double direct = mean_of_all(&eight.image, "direct.R") / mean_of_all(&four.image, "direct.R");
    print_message("eight passes / four: indirect %.4f, direct %.4f\n", ratio, direct);
    assert_true(fabs(ratio - 1) < 0.02);
    assert_true(fabs(direct - 1) < 0.02);
    assert_true(statistics_counter(&eight.statistics, "passes") == 8);
    /* The same paths in all: passes take up the numbers where the last one stopped. */
    assert_true(statistics_counter(&eight.statistics, "photons") ==
                statistics_counter(&four.statistics, "photons"));
    rendering_release(&four);
    rendering_release(&eight);
    free(four_text);
    free(eight_text);
}

static void test_seeds_make_other_noise(void **state)
{
    (void)state;
    char *text = cornell_with("seed: 5");
    struct rendering a = render(cornell, "injection=photon:count=5000", NULL);
    struct rendering b = render(text, "injection=photon:count=5000", NULL);
    double ratio = mean_of_all(&a.image, "indirect.R") / mean_of_all(&b.image, "indirect.R");
    assert_true(ratio != 1 && fabs(ratio - 1) < 0.05);
    rendering_release(&a);
    rendering_release(&b);
    free(text);
}

/* Bitwise the same channels for any number of threads and any size of batches. */
static void expect_determined(const char *const choices[])
{
    static const size_t batches[] = {4096, 500, 37};
    char *text = cornell_with("passes: 2");
    struct rendering first = render_text(text, 1, choices);
    assert_true(mean_of_all(&first.image, "indirect.G") > 0);
    for (uint32_t threads = 1; threads <= 3; threads++)
        for (size_t i = 0; i < sizeof batches / sizeof batches[0]; i++) {
            if (batches[i] < 100 && threads != 2)
                continue; /* slow */
            struct rendering other = render_text_in_batches(text, threads, batches[i], choices);
            expect_same_image(&first.image, &other.image);
            rendering_release(&other);
        }
    rendering_release(&first);
    free(text);
}

static void test_determined_with_shadow_maps(void **state)
{
    (void)state;
    const char *const choices[] = {"injection=photon:count=1000",
                                   "bounces=3",
                                   "visibility=shadowmap:resolution=5",
                                   "denoiser=gaussian",
                                   "normalization=weight",
                                   NULL};
    expect_determined(choices);
}

static void test_determined_without_visibility(void **state)
{
    (void)state;
    const char *const choices[] = {"injection=photon:count=1000", "visibility=none:radius=60",
                                   "filter=tent", NULL};
    expect_determined(choices);
}

static void test_rays_of_the_short_range_gather(void **state)
{
    (void)state;
    assert_int_equal(gathered_light_rays(400000), 170);
    assert_int_equal(gathered_light_rays(1600000), 340);
    assert_int_equal(gathered_light_rays(1), 16);
    assert_int_equal(gathered_light_rays(UINT64_MAX), 4096);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rays_of_the_short_range_gather),
        cmocka_unit_test(test_no_stratification_passes_photons_through),
        cmocka_unit_test(test_bounces_add_photons),
        cmocka_unit_test(test_ambient_fills_dark_pixels),
        cmocka_unit_test(test_layers_join),
        cmocka_unit_test(test_passes_keep_the_brightness),
        cmocka_unit_test(test_seeds_make_other_noise),
        cmocka_unit_test(test_determined_with_shadow_maps),
        cmocka_unit_test(test_determined_without_visibility),
    };
    return cmocka_run_group_tests(tests, read_cornell, release_cornell);
}
