/* test_reference.c: path tracing and splatting against pictures that renderers written elsewhere
 * made of the same box.
 *
 * $PSPLAT_SHARED/reference/cornell, 800x450, direct light, one bounce, all bounces: B_*.exr of the
 * spot-lit Cornell box, A_*.exr of the box under its lamp, whose pixels, as bright as it is, are
 * left out with those beside them. Path tracing's means must agree within a thousandth in each
 * channel, and no block of 25 x 25 pixels may be off by more than its noise and its anti-aliased
 * edges explain. Splatting's means must agree within its own bias.
 */
#include "external.h"
#include "image/image.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define BLOCK 25
#define LAMP 6.0f /* radiance that nothing but a lamp has */

static struct image load_reference(const char *name)
{
    char path[4096];
    struct image image = {0};
    struct error error;
    snprintf(path, sizeof path, "%s/reference/cornell/%s", getenv("PSPLAT_SHARED"), name);
    assert_int_equal(image_read_exr(path, &image, &error), PS_OK);
    return image;
}

/* Sum of a channel over the pixels that count in the rectangle, and their number. */
static double sum_of(const struct image *image, const char *channel, const bool *counts,
                     size_t left, size_t top, size_t width, size_t height, size_t *number)
{
    const float *samples = image_channel(image, channel);
    double sum = 0;
    *number = 0;
    assert_non_null(samples);
    for (size_t y = top; y < top + height; y++)
        for (size_t x = left; x < left + width; x++)
            if (counts[y * image->width + x]) {
                sum += samples[y * image->width + x];
                ++*number;
            }
    return sum;
}

static double mean_over(const struct image *image, const char *channel, const bool *counts)
{
    size_t number;
    double sum = sum_of(image, channel, counts, 0, 0, image->width, image->height, &number);
    return sum / (double)number;
}

static double worst_block(const struct image *a, const struct image *b, const bool *counts)
{
    double worst = 0, floor = 0.05 * mean_over(b, "G", counts);
    for (size_t y = 0; y + BLOCK <= a->height; y += BLOCK)
        for (size_t x = 0; x + BLOCK <= a->width; x += BLOCK) {
            size_t number;
            double ours = sum_of(a, "G", counts, x, y, BLOCK, BLOCK, &number);
            double theirs = sum_of(b, "G", counts, x, y, BLOCK, BLOCK, &number);
            if (number > BLOCK)
                worst = fmax(worst, fabs(ours - theirs) / (theirs + floor * (double)number));
        }
    return worst;
}

/* Pixels that neither show a lamp nor lie beside one that does; the caller frees them. */
static bool *pixels_without_lamp(const struct image *image)
{
    const float *red = image_channel(image, "R");
    bool *counts = malloc(image->width * image->height * sizeof *counts);
    assert_non_null(counts);
    for (size_t i = 0; i < image->width * image->height; i++)
        counts[i] = true;
    for (size_t y = 1; y + 1 < image->height; y++)
        for (size_t x = 1; x + 1 < image->width; x++)
            for (size_t k = 0; k < 9 && red[y * image->width + x] > LAMP; k++)
                counts[(y + k / 3 - 1) * image->width + x + k % 3 - 1] = false;
    return counts;
}

static void compare_to(const char *name, const char *text, const char *const choices[], double bias,
                       double block_bias)
{
    static const char *const channels[3] = {"R", "G", "B"};
    struct image theirs = load_reference(name);
    struct rendering ours = render_text(text, 2, choices);
    bool *counts = pixels_without_lamp(&theirs);
    for (int i = 0; i < 3; i++) {
        double ratio =
            mean_over(&ours.image, channels[i], counts) / mean_over(&theirs, channels[i], counts);
        print_message("%s, %s, %s: ratio of means %.5f\n", name, choices[0], channels[i], ratio);
        assert_true(fabs(ratio - 1) < bias);
    }
    double worst = worst_block(&ours.image, &theirs, counts);
    print_message("%s: worst block off by %.2f %%\n", name, 100 * worst);
    assert_true(worst < block_bias);
    free(counts);
    rendering_release(&ours);
    image_release(&theirs);
}

/* Renders a scene of the scenes folder as the picture was made. */
static void compare_scene(const char *name, const char *scene, int passes,
                          const char *const choices[], double bias, double block_bias)
{
    const char *source = getenv("PSPLAT_SOURCE");
    char text[4096];
    assert_non_null(source);
    snprintf(text, sizeof text,
             "psd: 1\n"
             "include: [\"%s/scenes/%s\"]\n"
             "image: {width: 800, height: 450}\n"
             "render: {passes: %d}\n",
             source, scene, passes);
    compare_to(name, text, choices, bias, block_bias);
}

static void compare(const char *name, const char *scene, int passes, const char *estimator,
                    const char *bounces)
{
    const char *const choices[] = {estimator, bounces, NULL};
    compare_scene(name, scene, passes, choices, 0.001, 0.04);
}

static void test_spot_direct(void **state)
{
    (void)state;
    compare("B_direct.exr", "cornell.psd", 16, "estimator=ambient:irradiance=0", "bounces=1");
}

static void test_spot_one_bounce(void **state)
{
    (void)state;
    compare("B_onebounce.exr", "cornell.psd", 8, "estimator=pathtrace:samples=8", "bounces=1");
}

static void test_spot_all_bounces(void **state)
{
    (void)state;
    compare("B_full.exr", "cornell.psd", 8, "estimator=pathtrace:samples=8", "bounces=all");
}

static void test_lamp_direct(void **state)
{
    (void)state;
    compare("A_direct.exr", "cornell-area.psd", 8, "estimator=ambient:irradiance=0", "bounces=1");
}

static void test_lamp_one_bounce(void **state)
{
    (void)state;
    compare("A_onebounce.exr", "cornell-area.psd", 16, "estimator=pathtrace:samples=4",
            "bounces=1");
}

static void test_lamp_all_bounces(void **state)
{
    (void)state;
    compare("A_full.exr", "cornell-area.psd", 16, "estimator=pathtrace:samples=4", "bounces=all");
}

static void test_lamp_by_splatting(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=splat", "injection=photon:count=400000",
                                          "bounces=all", NULL};
    compare_scene("A_full.exr", "cornell-area.psd", 4, choices, 0.005, 0.06);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spot_direct),       cmocka_unit_test(test_spot_one_bounce),
        cmocka_unit_test(test_spot_all_bounces),  cmocka_unit_test(test_lamp_direct),
        cmocka_unit_test(test_lamp_one_bounce),   cmocka_unit_test(test_lamp_all_bounces),
        cmocka_unit_test(test_lamp_by_splatting),
    };
    if (!external_files_are_there("reference/cornell"))
        return EXTERNAL_SKIPPED;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
