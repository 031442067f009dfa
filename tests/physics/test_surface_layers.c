/* test_surface_layers.c: albedo, normal, position and depth of pixels that see mirrors and glass.
 *
 * A mirror in which only the sky shows tells its own; where another surface shows in it, that one's
 * are told. Such a mirror changes no light beside it.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* The camera looks straight down, by 4: the left half of the picture is a mirror, the right half is
 * a floor. */
#define FROM_ABOVE(MATERIALS, OBJECTS)                                                             \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 4, 0], look_at: [0, 0, 0], up: [0, 0, -1], angle: 53.13}\n"            \
    "image: {width: 64, height: 64}\n"                                                             \
    "materials: {floor: {diffuse: 1}, " MATERIALS "}\n"                                            \
    "lights: [sky: {radiance: 1}]\n"                                                               \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[0, 0, 9], [9, 0, 9], [9, 0, -9], [0, 0, -9]], material: "               \
    "floor}\n" OBJECTS "render: {passes: 2, aa_samples: 4, seed: 3}\n"

static const char mirror[] = FROM_ABOVE(
    "mirror: {metal: {color: [0.9, 0.5, 0.25], roughness: 0}}",
    "  - quad: {corners: [[-9, 0, 9], [0, 0, 9], [0, 0, -9], [-9, 0, -9]], material: mirror}\n");

/* The same, and nothing at all on the left. */
static const char half_floor[] = FROM_ABOVE("mirror: {diffuse: 1}", "");

/* A slab of glass over a white floor. */
static const char glass[] = FROM_ABOVE(
    "ice: {dielectric: {ior: 1.5}}, mirror: {diffuse: 1}",
    "  - quad: {corners: [[-9, 0, 9], [0, 0, 9], [0, 0, -9], [-9, 0, -9]], material: mirror}\n"
    "  - box: {corners: [[-9, 1, -9], [9, 1.5, 9]], material: ice}\n");

static double of_mirror(const struct rendering *seen, const char *channel)
{
    return mean_of(&seen->image, channel, 15, 31, 2, 2);
}

static void test_a_mirror_of_the_sky_tells_its_own(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=ambient:irradiance=1", NULL};
    struct rendering seen = render_text(mirror, 2, choices);
    assert_true(fabs(of_mirror(&seen, "P.X") + 1) < 0.02);
    assert_true(fabs(of_mirror(&seen, "P.Y")) < 1e-4);
    assert_true(fabs(of_mirror(&seen, "N.Y") - 1) < 1e-4);
    assert_true(fabs(of_mirror(&seen, "Z") - sqrt(17)) < 0.02);
    assert_true(fabs(of_mirror(&seen, "albedo.R") - 0.9) < 0.01);
    assert_true(fabs(of_mirror(&seen, "albedo.B") - 0.25) < 0.02);
    assert_true(of_mirror(&seen, "indirect.G") == 0);
    rendering_release(&seen);
}

static void expect_same_floor(const char *denoiser)
{
    const char *const choices[] = {"estimator=ambient:irradiance=1", denoiser, NULL};
    struct rendering with = render_text(mirror, 2, choices);
    struct rendering without = render_text(half_floor, 2, choices);
    for (size_t x = 0; x < 64; x++) {
        double light = mean_of(&with.image, "indirect.G", x, 0, 1, 64);
        double expected = mean_of(&without.image, "indirect.G", x, 0, 1, 64);
        if (!(fabs(light - expected) <= 1e-5 * expected))
            fail_msg("%s, column %zu: %g, without the mirror %g", denoiser, x, light, expected);
    }
    rendering_release(&with);
    rendering_release(&without);
}

static void test_such_a_mirror_takes_no_part_in_denoising(void **state)
{
    (void)state;
    expect_same_floor("denoiser=gaussian:size=9x9");
    expect_same_floor("denoiser=bilateral:size=9");
    expect_same_floor("denoiser=regression");
}

static void test_glass_makes_no_albedo_above_1(void **state)
{
    (void)state;
    static const char *const choices[] = {"estimator=ambient:irradiance=1", NULL};
    struct rendering seen = render_text(glass, 2, choices);
    for (size_t y = 0; y < 64; y++)
        for (size_t x = 0; x < 64; x++)
            assert_true(mean_of(&seen.image, "albedo.G", x, y, 1, 1) <= 1);
    assert_true(mean_of_all(&seen.image, "albedo.G") > 0.9);
    rendering_release(&seen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_mirror_of_the_sky_tells_its_own),
        cmocka_unit_test(test_such_a_mirror_takes_no_part_in_denoising),
        cmocka_unit_test(test_glass_makes_no_albedo_above_1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
