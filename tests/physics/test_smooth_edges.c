/* test_smooth_edges.c: one pass with many samples at edges comes close to many passes.
 *
 * A ball on a checkered floor, under a spotlight that casts its shadow, with a mirror behind it and
 * as much indirect light everywhere: there are edges of things, textures, shadows and what a mirror
 * shows. Pixels off the edges are the same as without, bit for bit.
 */
#include "support/render_scene.h"
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "support/run_tests.h"

static const char scene[] =
    "psd: 1\n"
    "camera: {location: [0, 1.6, -4], look_at: [0, 0.6, 0], angle: 50}\n"
    "image: {width: 96, height: 54}\n"
    "materials:\n"
    "  floor: {diffuse: {checker: {colors: [0.2, 0.8], scale: 0.5}}}\n"
    "  ball: {diffuse: [0.8, 0.3, 0.2]}\n"
    "  mirror: {mirror: 0.9}\n"
    "lights:\n"
    "  - spotlight: {location: [-2, 4, -2], point_at: [0, 0, 0], radius: 60, falloff: 70,\n"
    "                intensity: 40}\n"
    "objects:\n"
    "  - quad: {corners: [[-4, 0, -3], [-4, 0, 3], [4, 0, 3], [4, 0, -3]], material: floor}\n"
    "  - sphere: {center: [0, 0.6, 0], radius: 0.6, material: ball}\n"
    "  - quad: {corners: [[0.5, 0, 2], [0.5, 2, 2], [2.5, 2, 1.5], [2.5, 0, 1.5]],\n"
    "           material: mirror}\n";

enum { TEXT = 2048 };

static void write_text(const char *objects, int passes, int aa_samples, char text[TEXT])
{
    snprintf(text, TEXT, "%srender: {passes: %d, aa_samples: %d}\n", objects, passes, aa_samples);
}

static struct rendering look_at(const char *objects, const char *estimator, int passes,
                                int aa_samples)
{
    const char *const choices[] = {estimator, NULL};
    char text[TEXT];
    write_text(objects, passes, aa_samples, text);
    return render_text(text, 2, choices);
}

static struct rendering look(int passes, int aa_samples)
{
    return look_at(scene, "estimator=ambient:irradiance=2", passes, aa_samples);
}

/* Relative RMSE of a channel. Albedo is a mean over what samples saw: where they saw nothing there
 * is none, however little of a pixel others see. */
static double error_of(const struct rendering *test, const struct rendering *reference,
                       const char *name)
{
    const float *a = image_channel(&test->image, name), *b = image_channel(&reference->image, name);
    bool of_surfaces = strcmp(name, "albedo.G") == 0;
    double squares = 0, all = 0;
    for (size_t i = 0; i < test->image.width * test->image.height; i++) {
        if (of_surfaces && a[i] == 0)
            continue;
        squares += pow((double)a[i] - b[i], 2);
        all += pow(b[i], 2);
    }
    return sqrt(squares / all);
}

static double share_of_equal(const struct rendering *a, const struct rendering *b, const char *name)
{
    const float *one = image_channel(&a->image, name), *other = image_channel(&b->image, name);
    size_t equal = 0, pixels = a->image.width * a->image.height;
    for (size_t i = 0; i < pixels; i++)
        equal += one[i] == other[i];
    return (double)equal / (double)pixels;
}

static void test_one_pass_comes_close_to_many(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "direct.G", "indirect.G", "albedo.G", "N.Y"};
    struct rendering reference = look(1024, 1), plain = look(1, 1), smooth = look(1, 64);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        double without = error_of(&plain, &reference, names[i]);
        double with = error_of(&smooth, &reference, names[i]);
        print_message("%s: %.2f %% without, %.2f %% with\n", names[i], 100 * without, 100 * with);
        assert_true(with < without / 4);
    }
    double equal = share_of_equal(&smooth, &plain, "R");
    print_message("%.1f %% of the pixels are the same\n", 100 * equal);
    assert_true(equal > 0.5 && equal < 0.95);
    rendering_release(&reference);
    rendering_release(&plain);
    rendering_release(&smooth);
}

/* Bright bars before black, thinner than a pixel; the second camera has a lens that looks past
 * them. */
#define BARS                                                                                       \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-0.31, -2, 0], [-0.31, 2, 0], [-0.30, 2, 0], [-0.30, -2, 0]],\n"        \
    "           material: shining}\n"                                                              \
    "  - quad: {corners: [[-2, 0.203, 0], [-2, 0.21, 0], [2, 0.22, 0], [2, 0.213, 0]],\n"          \
    "           material: shining}\n"

/* A pane of glass, which mirrors a bright surface behind the camera a little. */
#define PANE                                                                                       \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-2, -2, 0], [-2, 2, 0], [2, 2, 0], [2, -2, 0]], material: glass}\n"     \
    "  - quad: {corners: [[-9, -9, -5], [9, -9, -5], [9, 9, -5], [-9, 9, -5]],\n"                  \
    "           material: shining}\n"

static double mean_light(const char *camera, const char *objects, int passes, int aa_samples)
{
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    static const char format[] = "psd: 1\n"
                                 "camera: {location: [0, 0, -4], look_at: [0, 0, 0], angle: 30%s}\n"
                                 "image: {width: 20, height: 14}\n"
                                 "materials:\n"
                                 "  shining: {diffuse: 0, emission: 1, emission_both: yes}\n"
                                 "  glass: {dielectric: {ior: 1.5}}\n"
                                 "%s"
                                 "render: {passes: %d, aa_samples: %d}\n";
    char text[2048];
    snprintf(text, sizeof text, format, camera, objects, passes, aa_samples);
    struct rendering rendering = render_text(text, 2, choices);
    double mean = mean_of_all(&rendering.image, "R");
    rendering_release(&rendering);
    return mean;
}

/* Neither what is rarely hit nor what is rarely chosen goes missing, as it would if looks that
 * differ from their neighbours were replaced pass by pass. */
static void test_the_mean_stays(void **state)
{
    (void)state;
    static const struct {
        const char *name, *camera, *objects;
    } cases[] = {
        {"bars", "", BARS},
        {"bars out of focus", ", aperture: 0.2, focus: 8", BARS},
        {"a pane", "", PANE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double expected = mean_light(cases[i].camera, cases[i].objects, 4096, 1);
        double mean = mean_light(cases[i].camera, cases[i].objects, 512, 8);
        print_message("%s: %.4f of the mean without\n", cases[i].name, mean / expected);
        assert_true(expected > 0.005 && fabs(mean / expected - 1) < 0.03);
    }
}

/* Passes go on from each other's samples. */
static void test_passes_add_to_it(void **state)
{
    (void)state;
    struct rendering reference = look(1024, 1), one = look(1, 4), sixteen = look(16, 4);
    double first = error_of(&one, &reference, "R"), last = error_of(&sixteen, &reference, "R");
    print_message("4 samples: %.2f %%; in 16 passes: %.2f %%\n", 100 * first, 100 * last);
    assert_true(last < first / 3);
    rendering_release(&reference);
    rendering_release(&one);
    rendering_release(&sixteen);
}

/* A beam on posts before a lamp: its underside shows as four rows of pixels, brightest where it
 * meets the posts. */
static const char beam[] =
    "psd: 1\n"
    "camera: {location: [0, 1.2, 8.5], look_at: [-0.5, 2.7, -2], angle: 10}\n"
    "image: {width: 96, height: 54}\n"
    "materials: {stone: {diffuse: 0.8}}\n"
    "lights:\n"
    "  - point: {location: [0, 3.6, 0.5], intensity: 40}\n"
    "objects:\n"
    "  - quad: {corners: [[-6, 0, 7], [6, 0, 7], [6, 0, -4], [-6, 0, -4]], material: stone}\n"
    "  - box: {corners: [[-1.25, 0, -2.3], [-0.75, 2.8, -1.9]], material: stone}\n"
    "  - box: {corners: [[0.25, 0, -2.3], [0.75, 2.8, -1.9]], material: stone}\n"
    "  - box: {corners: [[-3.6, 2.8, -2.4], [3.6, 3.2, -1.6]], material: stone}\n";

/* Samples at edges have the light of pixels that are near to what they see, and see the same
 * surface: the underside has no light of the front's. */
static void test_light_at_edges_is_that_nearby(void **state)
{
    (void)state;
    struct rendering reference = look_at(beam, "estimator=pathtrace:samples=32", 256, 1);
    struct rendering smooth = look_at(beam, "estimator=pathtrace:samples=1024", 1, 16);
    double error = error_of(&smooth, &reference, "indirect.G");
    print_message("indirect light of the beam: %.2f %%\n", 100 * error);
    assert_true(error < 0.045);
    rendering_release(&reference);
    rendering_release(&smooth);
}

/* Pixels off the edges keep the light that rays by chance found for them, for a denoiser to see. */
static void test_noise_off_the_edges_stays(void **state)
{
    (void)state;
    static const char noisy[] = "estimator=pathtrace:samples=1", even[] = "estimator=ambient";
    struct rendering plain = look_at(beam, noisy, 1, 1), smooth = look_at(beam, noisy, 1, 8);
    struct rendering light = look_at(beam, even, 1, 1), edges = look_at(beam, even, 1, 8);
    double same = share_of_equal(&plain, &smooth, "indirect.G");
    double off_edges = share_of_equal(&light, &edges, "R");
    print_message("%.3f of the pixels are the same, %.3f are off the edges\n", same, off_edges);
    assert_true(off_edges < 0.95);
    assert_true(same >= off_edges);
    rendering_release(&plain);
    rendering_release(&smooth);
    rendering_release(&light);
    rendering_release(&edges);
}

/* A ball of glass, along whose rim what is seen changes within a pixel, and each of the ways that
 * light takes in it shows something else. */
static const char glass_ball[] =
    "psd: 1\n"
    "camera: {location: [0, 1.6, -4], look_at: [0, 0.6, 0], angle: 20}\n"
    "image: {width: 64, height: 64}\n"
    "materials:\n"
    "  floor: {diffuse: {checker: {colors: [0.2, 0.8], scale: 0.5}}}\n"
    "  glass: {dielectric: {ior: 1.5}}\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, -9], [-9, 0, 9], [9, 0, 9], [9, 0, -9]], material: floor}\n"
    "  - quad: {corners: [[-9, 0, 9], [-9, 9, 9], [9, 9, 9], [9, 0, 9]], material: floor}\n"
    "  - sphere: {center: [0, 0.6, 0], radius: 0.6, material: glass}\n";

static void test_glass_takes_more_samples(void **state)
{
    (void)state;
    static const char even[] = "estimator=ambient:irradiance=2";
    struct rendering reference = look_at(glass_ball, even, 256, 8);
    struct rendering one = look_at(glass_ball, even, 1, 8);
    double error = error_of(&one, &reference, "R");
    print_message("a ball of glass: %.2f %%\n", 100 * error);
    assert_true(error < 0.055);
    rendering_release(&reference);
    rendering_release(&one);
}

/* Through a pane the foot of a bright wall is seen, and the floor before the pane, mirrored: what
 * of it a sample has, chance decides. */
static const char pane[] =
    "psd: 1\n"
    "camera: {location: [0, 1.2, -2], look_at: [0, 0.45, 0], angle: 12}\n"
    "image: {width: 32, height: 32}\n"
    "materials: {stone: {diffuse: 0.8}, glass: {dielectric: {ior: 1.5}}}\n"
    "lights:\n"
    "  - spotlight: {location: [0, 0.4, 1.2], point_at: [0, 0.3, 2], radius: 15, falloff: 20,\n"
    "                intensity: 10}\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, -9], [-9, 0, 2], [9, 0, 2], [9, 0, -9]], material: stone}\n"
    "  - quad: {corners: [[-9, 0, 2], [-9, 1, 2], [9, 1, 2], [9, 0, 2]], material: stone}\n"
    "  - quad: {corners: [[-2, 0.1, 0], [-2, 2, 0], [2, 2, 0], [2, 0.1, 0]], material: glass}\n";

/* The light of the floor falls off steeply, and is no chance that a tile's pixels might share. */
static void test_light_behind_glass_stays_where_it_is(void **state)
{
    (void)state;
    struct rendering reference = look_at(pane, "estimator=pathtrace:samples=16", 512, 1);
    struct rendering smooth = look_at(pane, "estimator=pathtrace:samples=16", 32, 16);
    for (size_t y = 15; y < 28; y += 8) {
        double expected = mean_of(&reference.image, "indirect.G", 0, y, 32, 4);
        double mean = mean_of(&smooth.image, "indirect.G", 0, y, 32, 4);
        print_message("rows from %zu on: %.3f of the light\n", y, mean / expected);
        assert_float_equal(mean / expected, 1.0, 0.05);
    }
    rendering_release(&reference);
    rendering_release(&smooth);
}

/* How often a render asks whether it was cancelled, and when it is told so. */
struct patience {
    int asked, most;
};

static bool is_out(void *user)
{
    struct patience *patience = user;
    return ++patience->asked > patience->most;
}

static ps_result look_until(struct patience *patience, struct rendering *rendering)
{
    static const char *const choices[] = {"estimator=ambient:irradiance=2", NULL};
    char text[TEXT];
    struct prepared prepared;
    struct error error;
    const struct render_callbacks callbacks = {.user = patience, .cancelled = is_out};
    write_text(scene, 1, 64, text);
    prepare_text(text, 1, 100, choices, &prepared);
    statistics_init(&rendering->statistics);
    ps_result result = render_run(&prepared.scene, &prepared.settings, &callbacks,
                                  &rendering->statistics, NULL, &rendering->image, &error);
    prepared_release(&prepared);
    return result;
}

/* The last that asks are tiles at the edges. What was found before makes a picture without smooth
 * edges. */
static void test_cancelled_at_the_edges(void **state)
{
    (void)state;
    struct patience patient = {0, INT_MAX};
    struct rendering whole, part, without = look(1, 1);
    assert_int_equal(look_until(&patient, &whole), PS_OK);
    struct patience impatient = {0, patient.asked - 3};
    assert_int_equal(look_until(&impatient, &part), PS_CANCELLED);
    double off = error_of(&part, &without, "R");
    print_message("cancelled: %.1e off the picture without smooth edges\n", off);
    assert_true(off < 1e-6 && error_of(&whole, &without, "R") > 0.01);
    rendering_release(&whole);
    rendering_release(&part);
    rendering_release(&without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_pass_comes_close_to_many),
        SLOW_TEST(test_passes_add_to_it),
        cmocka_unit_test(test_light_at_edges_is_that_nearby),
        cmocka_unit_test(test_noise_off_the_edges_stays),
        cmocka_unit_test(test_glass_takes_more_samples),
        cmocka_unit_test(test_light_behind_glass_stays_where_it_is),
        cmocka_unit_test(test_the_mean_stays),
        cmocka_unit_test(test_cancelled_at_the_edges),
    };
    return RUN_TESTS(tests);
}
