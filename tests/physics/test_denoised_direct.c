/* test_denoised_direct.c: direct light through a denoiser that asks for it (PS_DENOISER_DIRECT):
 * soft shadows have less noise and the same mean; what has no noise stays as it is.
 *
 * A floor under a rectangular lamp and under a lamp without a size, of half the light each, with a
 * box on it: a penumbra across a hard shadow.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define WIDTH 120
#define HEIGHT 90
#define PIXELS (WIDTH * HEIGHT)

static const char scene[] =
    "psd: 1\n"
    "camera: {location: [0, 6, 5], look_at: [0, 0.3, 0], angle: 40}\n"
    "image: {width: 120, height: 90}\n"
    "materials: {floor: {diffuse: [0.7, 0.5, 0.3]}, box: {diffuse: 0.6}, lamp: {diffuse: 0.5, "
    "emission: 8}}\n"
    "lights:\n"
    "  - point: {location: [-4, 5, 2], intensity: 30}\n"
    "%s"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor}\n"
    "  - box: {corners: [[-0.5, 0, -0.5], [0.5, 1, 0.5]], material: box}\n"
    "%s"
    "render: {light_samples: %d, passes: %d, discontinuity_buffer: %s, seed: 3}\n";

static const char lamp[] =
    "  - rectangle: {corners: [[1, 4, -1], [3, 4, -1], [3, 4, 1]], radiance: 8, visible: no}\n";

/* Shines as well, and is seen. */
static const char bulb[] = "  - sphere: {center: [-1.5, 0.2, 0.5], radius: 0.2, material: lamp}\n";

struct setting {
    const char *lamp, *bulb;
    int samples, passes;
    bool joined;
};

static struct rendering render(struct setting setting, const char *denoiser, uint32_t threads)
{
    const char *const choices[] = {"estimator=ambient:irradiance=0", denoiser, NULL};
    char text[2048];
    snprintf(text, sizeof text, scene, setting.lamp, setting.bulb, setting.samples, setting.passes,
             setting.joined ? "yes" : "no");
    return render_text(text, threads, choices);
}

static double deviation(const struct image *image, const struct image *truth)
{
    double sum = 0, scale = 0;
    for (int i = 0; i < PIXELS; i++) {
        double a = image_channel(image, "direct.G")[i], b = image_channel(truth, "direct.G")[i];
        if (b > 1) /* the lamp */
            continue;
        sum += (a - b) * (a - b);
        scale += b * b;
    }
    return sqrt(sum / scale);
}

/* One pass, or four: every pass looks at other points of the pixels. */
static void expect_less_noise(int samples, int passes)
{
    struct setting setting = {lamp, bulb, samples, passes, false};
    struct setting many = {lamp, bulb, 1024, passes, false};
    struct rendering truth = render(many, "denoiser=none", 2);
    struct rendering noisy = render(setting, "denoiser=none", 2);
    struct rendering smooth = render(setting, "denoiser=regression", 2);
    double before = deviation(&noisy.image, &truth.image),
           after = deviation(&smooth.image, &truth.image);
    double mean = mean_of_all(&smooth.image, "direct.G") / mean_of_all(&truth.image, "direct.G");
    print_message("%d rays, %d passes: deviation %.4f -> %.4f, mean / truth %.4f\n", samples,
                  passes, before, after, mean);
    assert_true(after < 0.65 * before);
    assert_true(fabs(mean - 1) < 2e-3);
    rendering_release(&truth);
    rendering_release(&noisy);
    rendering_release(&smooth);
}

static void test_soft_shadows_have_less_noise(void **state)
{
    (void)state;
    expect_less_noise(2, 1);
    expect_less_noise(5, 1);
    expect_less_noise(1, 4);
}

/* Bit for bit. */
static void expect_the_same(struct setting setting)
{
    struct rendering noisy = render(setting, "denoiser=none", 2);
    struct rendering smooth = render(setting, "denoiser=regression", 2);
    static const char *const channels[] = {"direct.R", "direct.G", "direct.B"};
    for (int c = 0; c < 3; c++)
        assert_memory_equal(image_channel(&noisy.image, channels[c]),
                            image_channel(&smooth.image, channels[c]), PIXELS * sizeof(float));
    rendering_release(&noisy);
    rendering_release(&smooth);
}

static void test_it_stays_where_nothing_tells_its_noise(void **state)
{
    (void)state;
    expect_the_same((struct setting){lamp, bulb, 1, 1, false});
    expect_the_same((struct setting){lamp, bulb, 4, 1, true}); /* by the discontinuity buffer */
}

/* A lamp that shines on nothing makes the scene one with area lights, all the same. */
static void test_hard_shadows_stay(void **state)
{
    (void)state;
    static const char away[] = "  - rectangle: {corners: [[1, -4, -1], [3, -4, -1], [3, -4, 1]], "
                               "radiance: 8, visible: no}\n";
    struct setting setting = {away, "", 4, 1, false};
    struct rendering before = render(setting, "denoiser=none", 2);
    struct rendering after = render(setting, "denoiser=regression", 2);
    double off = deviation(&after.image, &before.image);
    print_message("hard shadows: off by %.1e\n", off);
    assert_true(off < 1e-5);
    rendering_release(&before);
    rendering_release(&after);
}

/* Under a noisy sky the edges of a sun's shadows stay where they are: off by less than half of what
 * a denoiser of the whole direct light leaves (4 %). */
static void test_hard_shadows_stay_under_a_noisy_sky(void **state)
{
    (void)state;
    static const char lights[] = "  - sun: {direction: [-2, -1, -1], irradiance: 6}\n"
                                 "  - sky: {radiance: 0.5}\n";
    struct setting setting = {lights, "", 2, 1, false};
    struct setting many = {lights, "", 1024, 1, false};
    struct rendering truth = render(many, "denoiser=none", 2);
    struct rendering noisy = render(setting, "denoiser=none", 2);
    struct rendering smooth = render(setting, "denoiser=regression", 2);
    double before = deviation(&noisy.image, &truth.image);
    double after = deviation(&smooth.image, &truth.image);
    print_message("sun and sky: deviation %.4f -> %.4f\n", before, after);
    assert_true(before > 0.05);
    assert_true(after < 0.02);
    rendering_release(&truth);
    rendering_release(&noisy);
    rendering_release(&smooth);
}

/* What lamps emit is no light that they reflect. */
static void test_emission_stays(void **state)
{
    (void)state;
    struct setting setting = {lamp, bulb, 4, 1, false};
    struct rendering before = render(setting, "denoiser=none", 2);
    struct rendering after = render(setting, "denoiser=regression", 2);
    int seen = 0;
    for (int i = 0; i < PIXELS; i++) {
        float a = image_channel(&after.image, "direct.G")[i];
        float b = image_channel(&before.image, "direct.G")[i];
        if (b < 8)
            continue;
        seen++;
        assert_true(fabsf(a - b) < 0.1f && a >= 8);
    }
    assert_true(seen > 20);
    rendering_release(&before);
    rendering_release(&after);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    struct setting setting = {lamp, bulb, 3, 2, false};
    struct rendering one = render(setting, "denoiser=regression", 1);
    struct rendering three = render(setting, "denoiser=regression", 3);
    expect_same_image(&one.image, &three.image);
    rendering_release(&one);
    rendering_release(&three);
}

/* A sphere of albedo 0.4 before a sky of radiance 1: what is partly sky is no brighter than the
 * sky. */
static void test_silhouettes_before_the_sky(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=ambient:irradiance=0", "denoiser=regression",
                                          NULL};
    static const char text[] = "psd: 1\n"
                               "camera: {location: [0, 1, 6], look_at: [0, 1.2, 0], angle: 40}\n"
                               "image: {width: 120, height: 90}\n"
                               "materials: {grey: {diffuse: 0.4}}\n"
                               "lights: [{sky: {radiance: 1}}]\n"
                               "objects:\n"
                               "  - sphere: {center: [0, 1.2, 0], radius: 1, material: grey}\n"
                               "  - box: {corners: [[-3, -0.1, -3], [3, 0, 3]], material: grey}\n"
                               "render: {light_samples: 2, aa_samples: 8, seed: 1}\n";
    struct rendering rendering = render_text(text, 2, choices);
    const float *direct = image_channel(&rendering.image, "direct.G");
    size_t partly = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(direct[i] < 1.005f);
        partly += direct[i] > 0.5f && direct[i] < 0.95f;
    }
    assert_true(partly > 20);
    rendering_release(&rendering);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_soft_shadows_have_less_noise),
        cmocka_unit_test(test_it_stays_where_nothing_tells_its_noise),
        cmocka_unit_test(test_hard_shadows_stay),
        cmocka_unit_test(test_hard_shadows_stay_under_a_noisy_sky),
        cmocka_unit_test(test_emission_stays),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_silhouettes_before_the_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
