/* test_reference.c: path tracing against pictures that renderers written elsewhere made of the same
 * box.
 *
 * $PSPLAT_SHARED/reference/cornell/B_*.exr, 800x450: the spot-lit Cornell box, direct light, one
 * bounce, all bounces. Means must agree within half a per cent in each channel, and no block of 25
 * x 25 pixels may be off by more than its noise and its anti-aliased edges explain.
 */
#include "image/image.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define BLOCK 25

/* Skips the test with a line where the pictures are absent. */
static struct image load_reference(const char *name)
{
    char path[4096];
    const char *shared = getenv("PSPLAT_SHARED");
    struct image image = {0};
    struct error error;
    snprintf(path, sizeof path, "%s/reference/cornell/%s", shared ? shared : "", name);
    FILE *file = fopen(path, "rb");
    if (!file) {
        print_message("skipped: there is no %s\n", path);
        skip();
    }
    fclose(file);
    assert_int_equal(image_read_exr(path, &image, &error), PS_OK);
    return image;
}

static double worst_block(const struct image *a, const struct image *b)
{
    double worst = 0;
    for (size_t y = 0; y + BLOCK <= a->height; y += BLOCK)
        for (size_t x = 0; x + BLOCK <= a->width; x += BLOCK) {
            double ours = mean_of(a, "G", x, y, BLOCK, BLOCK);
            double theirs = mean_of(b, "G", x, y, BLOCK, BLOCK);
            double scale = theirs + 0.05 * mean_of_all(b, "G");
            worst = fmax(worst, fabs(ours - theirs) / scale);
        }
    return worst;
}

static void compare(const char *name, const char *estimator)
{
    static const char *const channels[3] = {"R", "G", "B"};
    struct image theirs = load_reference(name);
    char *text = cornell_text(800, 450), *seeded = strstr(text, "render:\n");
    assert_non_null(seeded);
    size_t bytes = strlen(text) + 64;
    char *with_passes = malloc(bytes);
    assert_non_null(with_passes);
    snprintf(with_passes, bytes, "%.*srender:\n  passes: 16\n%s", (int)(seeded - text), text,
             seeded + strlen("render:\n"));
    const char *const choices[] = {estimator, NULL};
    struct rendering ours = render_text(with_passes, 2, choices);
    for (int i = 0; i < 3; i++) {
        double ratio = mean_of_all(&ours.image, channels[i]) / mean_of_all(&theirs, channels[i]);
        print_message("%s %s: ratio of means %.5f\n", name, channels[i], ratio);
        assert_true(fabs(ratio - 1) < 0.005);
    }
    double worst = worst_block(&ours.image, &theirs);
    print_message("%s: worst block off by %.2f %%\n", name, 100 * worst);
    assert_true(worst < 0.05);
    rendering_release(&ours);
    image_release(&theirs);
    free(with_passes);
    free(text);
}

static void test_direct(void **state)
{
    (void)state;
    compare("B_direct.exr", "estimator=ambient:irradiance=0");
}

static void test_one_bounce(void **state)
{
    (void)state;
    compare("B_onebounce.exr", "estimator=pathtrace:samples=8,bounces=1");
}

static void test_all_bounces(void **state)
{
    (void)state;
    compare("B_full.exr", "estimator=pathtrace:samples=8,bounces=0");
}

/* Sanitizers make these renders ten times slower, and find nothing here that smaller tests don't
 * run into. */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

int main(void)
{
#ifdef SANITIZED
    print_message("skipped: too slow under sanitizers\n");
    return 0;
#endif
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_direct),
        cmocka_unit_test(test_one_bounce),
        cmocka_unit_test(test_all_bounces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
