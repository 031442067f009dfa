/* test_denoised_gloss.c: the indirect light of gloss in which the sky is mirrored, of one pass
 * through a denoiser; and of glass, without one.
 *
 * A path from a pixel of the floor, or of the glass, goes on to the wall or past it to the sky, by
 * chance, and has no indirect light there. Light is even (estimator `ambient`), so that all that
 * pixels differ by is this chance.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#define WIDTH 96
#define HEIGHT 64

static const char pane[] =
    "psd: 1\n"
    "camera: {location: [0, 2, 5], look_at: [0, 2, 0], angle: 40}\n"
    "image: {width: 96, height: 64}\n"
    "materials: {pane: {dielectric: {ior: 1.5}}, wall: {diffuse: 0.6}}\n"
    "lights: [sky: {radiance: 1}]\n"
    "objects:\n"
    "  - box: {corners: [[-9, -9, 1], [9, 9, 1.1]], material: pane}\n"
    "  - quad: {corners: [[-9, -9, -1], [9, -9, -1], [9, 9, -1], [-9, 9, -1]], material: wall}\n"
    "render: {passes: 1, aa_samples: 8, seed: 3}\n";

static const char scene[] =
    "psd: 1\n"
    "camera: {location: [0, 2, 5], look_at: [0, 0, 0], angle: 40}\n"
    "image: {width: 96, height: 64}\n"
    "materials: {floor: {glossy: {diffuse: 0.3, specular: 0.3, roughness: 0.5}}, wall: {diffuse: "
    "0.6}}\n"
    "lights: [sky: {radiance: 1}]\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor}\n"
    "  - quad: {corners: [[-9, 0, -9], [9, 0, -9], [9, 4, -9], [-9, 4, -9]], material: wall}\n"
    "render: {passes: 1, aa_samples: 8, seed: 3}\n";

/* Of the floor, or of the glass. */
static double grain_in_the_middle(const struct image *image)
{
    return grain_of(image, "indirect.G", 8, HEIGHT / 2, WIDTH - 16, HEIGHT / 2 - 8);
}

static void test_chance_to_mirror_the_sky_leaves_no_specks(void **state)
{
    (void)state;
    static const char *const raw[] = {"estimator=ambient:irradiance=1", "denoiser=none", NULL};
    static const char *const smooth[] = {"estimator=ambient:irradiance=1", "denoiser=regression",
                                         NULL};
    struct rendering before = render_text(scene, 2, raw), after = render_text(scene, 2, smooth);
    double was = grain_in_the_middle(&before.image), is = grain_in_the_middle(&after.image);
    double mean =
        mean_of_all(&after.image, "indirect.G") / mean_of_all(&before.image, "indirect.G");
    print_message("grain %.4f -> %.4f, mean %.4f\n", was, is, mean);
    assert_true(was > 0.02);
    assert_true(is < 0.2 * was);
    assert_true(fabs(mean - 1) < 5e-3);
    rendering_release(&before);
    rendering_release(&after);
}

/* Both faces mirror 4 %, once each as a rule. */
static void test_all_pixels_of_glass_see_both_ways(void **state)
{
    (void)state;
    static const char *const raw[] = {"estimator=ambient:irradiance=1", "denoiser=none", NULL};
    struct rendering seen = render_text(pane, 2, raw);
    double grain = grain_in_the_middle(&seen.image);
    double mean = mean_of_all(&seen.image, "indirect.G") * (double)PS_PI / 0.6;
    print_message("grain %.4f, share of the wall's light %.4f\n", grain, mean);
    assert_true(grain < 0.08);
    assert_true(fabs(mean - 0.923) < 0.01); /* (1 - R) / (1 + R), R = 0.04 */
    rendering_release(&seen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chance_to_mirror_the_sky_leaves_no_specks),
        cmocka_unit_test(test_all_pixels_of_glass_see_both_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
