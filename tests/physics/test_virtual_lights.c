/* test_virtual_lights.c: what maps over hemispheres hide of virtual lights is what shadow rays hide
 * of them, and lightcuts find the light of all lights by few.
 *
 * Means, compensation included, are compared with path tracing in test_agreement.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define WIDTH 96
#define HEIGHT 54
#define ACROSS 6 /* blocks of pixels that are compared, as a whole each */
#define DOWN 3

static struct rendering render(const char *text, const char *estimator)
{
    const char *const choices[] = {"injection=photon:count=2000", estimator, NULL};
    return render_text(text, 2, choices);
}

static double luminance_of(const struct image *image, size_t x, size_t y, size_t width,
                           size_t height)
{
    return 0.2126 * mean_of(image, "indirect.R", x, y, width, height) +
           0.7152 * mean_of(image, "indirect.G", x, y, width, height) +
           0.0722 * mean_of(image, "indirect.B", x, y, width, height);
}

/* How far blocks are off those of the other picture, relatively. */
struct difference {
    double largest, root_mean_square;
};

static struct difference difference_of(const struct image *image, const struct image *reference)
{
    const size_t width = WIDTH / ACROSS, height = HEIGHT / DOWN;
    struct difference difference = {0, 0};
    double squares = 0, count = 0;
    for (size_t y = 0; y + height <= HEIGHT; y += height)
        for (size_t x = 0; x + width <= WIDTH; x += width) {
            double expected = luminance_of(reference, x, y, width, height);
            if (!(expected > 0))
                continue;
            double off = luminance_of(image, x, y, width, height) / expected - 1;
            difference.largest = fmax(difference.largest, fabs(off));
            squares += off * off;
            count++;
        }
    difference.root_mean_square = sqrt(squares / count);
    return difference;
}

static void test_maps_agree_with_shadow_rays(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    struct rendering rays = render(text, "estimator=vpl:visibility=rays");
    struct rendering map = render(text, "estimator=vpl:visibility=map");
    struct rendering none = render(text, "estimator=vpl:visibility=none");
    double of_map = difference_of(&map.image, &rays.image).largest;
    double of_none = difference_of(&none.image, &rays.image).largest;
    print_message("off by up to %.2f %%; without visibility %.0f %%\n", 100 * of_map,
                  100 * of_none);
    assert_true(of_map < 0.02);
    assert_true(of_none > 0.2);
    rendering_release(&rays);
    rendering_release(&map);
    rendering_release(&none);
    free(text);
}

/* Maps of so many rays that the lights go in two batches. */
static void test_large_maps(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    struct rendering rays = render(text, "estimator=vpl:lights=60,visibility=rays");
    struct rendering map = render(text, "estimator=vpl:lights=60,resolution=512");
    struct difference difference = difference_of(&map.image, &rays.image);
    print_message("off by up to %.3f %%\n", 100 * difference.largest);
    assert_true(difference.largest < 0.002);
    rendering_release(&rays);
    rendering_release(&map);
    free(text);
}

/* The sun shines on a floor, which lights an object over it; the camera sees that alone. */
static const char over_floor[] =
    "psd: 1\n"
    "camera: {location: [3, 1, 4], look_at: [0, 1, 0], projection: orthographic, width: 0.6}\n"
    "image: {width: 32, height: 32}\n"
    "materials: {floor: {diffuse: 0.5}, object: {diffuse: 0.6}}\n"
    "lights:\n"
    "  - sun: {direction: [1, -4, 1], irradiance: 2, angle: 0}\n"
    "objects:\n"
    "  - quad: {corners: [[-8, 0, -8], [-8, 0, 8], [8, 0, 8], [8, 0, -8]], material: floor}\n"
    "  - %s\n";

/* However coarse the map is: the points of a cell that the object lies in are those of several of
 * its sides. */
static void expect_no_shadow_of_itself(const char *object)
{
    char text[1024];
    snprintf(text, sizeof text, over_floor, object);
    struct rendering map = render(text, "estimator=vpl:visibility=map,resolution=8,compensation=0");
    struct rendering none = render(text, "estimator=vpl:visibility=none,compensation=0");
    assert_true(mean_of_all(&none.image, "indirect.G") > 0);
    expect_same_image(&map.image, &none.image);
    rendering_release(&map);
    rendering_release(&none);
}

static void test_convex_objects_do_not_shadow_themselves(void **state)
{
    (void)state;
    expect_no_shadow_of_itself("sphere: {center: [0, 1, 0], radius: 0.5, material: object}");
    expect_no_shadow_of_itself(
        "box: {corners: [[-0.5, 0.5, -0.5], [0.5, 1.5, 0.5]], material: object}");
}

/* A cut of single lights is all of them. */
static void test_finest_cuts_are_all_lights(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    struct rendering all = render(text, "estimator=vpl:lights=300,visibility=rays");
    struct rendering cuts = render(text, "estimator=lightcuts:lights=300,error=0");
    double difference = difference_of(&cuts.image, &all.image).largest;
    print_message("off by up to %.5f %%\n", 100 * difference);
    assert_true(difference < 1e-4);
    rendering_release(&all);
    rendering_release(&cuts);
    free(text);
}

/* Clusters in the cut of a pixel, and how far light is off that of all lights. */
static double measure_cuts(const char *text, int lights, double *difference)
{
    char cut_choice[64], all_choice[64], count[64];
    snprintf(cut_choice, sizeof cut_choice, "estimator=lightcuts:lights=%d", lights);
    snprintf(all_choice, sizeof all_choice, "estimator=vpl:lights=%d,visibility=rays", lights);
    snprintf(count, sizeof count, "injection=photon:count=%d", lights);
    const char *const cut_choices[] = {count, cut_choice, NULL};
    const char *const all_choices[] = {count, all_choice, NULL};
    struct rendering cuts = render_text(text, 2, cut_choices);
    struct rendering all = render_text(text, 2, all_choices);
    double clusters = statistics_counter(&cuts.statistics, "light cut clusters");
    *difference = difference_of(&cuts.image, &all.image).root_mean_square;
    rendering_release(&cuts);
    rendering_release(&all);
    return clusters / (WIDTH * HEIGHT);
}

static void test_cuts_grow_slower_than_lights(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    double of_few, of_many;
    double few = measure_cuts(text, 1000, &of_few), many = measure_cuts(text, 16000, &of_many);
    print_message("1,000 lights: %.0f clusters, off by %.2f %%; 16,000: %.0f, %.2f %%\n", few,
                  100 * of_few, many, 100 * of_many);
    assert_true(many < 3 * few);
    assert_true(few < 250);
    assert_true(of_few < 0.02);
    assert_true(of_many < 0.02);
    free(text);
}

/* The sun shines on a strip of floor, which lights a small ceiling over its end: near lights give
 * ten times what far ones do. */
static const char strip[] =
    "psd: 1\n"
    "camera: {location: [9.5, 3, 0], look_at: [9.5, 6, 0], up: [1, 0, 0], projection: "
    "orthographic, width: 0.1}\n"
    "image: {width: 4, height: 4}\n"
    "materials: {white: {diffuse: 0.8}}\n"
    "lights:\n"
    "  - sun: {direction: [0, -1, 0], irradiance: 2, angle: 0}\n"
    "objects:\n"
    "  - quad: {corners: [[0, 0, -0.5], [0, 0, 0.5], [8, 0, 0.5], [8, 0, -0.5]], material: white}\n"
    "  - quad: {corners: [[9.4, 6, -0.1], [9.6, 6, -0.1], [9.6, 6, 0.1], [9.4, 6, 0.1]], material: "
    "white}\n"
    "render: {passes: 3000}\n";

static double light_of_strip(const char *estimator)
{
    const char *const choices[] = {"injection=photon:count=500", estimator, NULL};
    struct rendering rendering = render_text(strip, 2, choices);
    double light = mean_of_all(&rendering.image, "indirect.G");
    rendering_release(&rendering);
    return light;
}

/* Representatives are drawn in proportion to power: one light alone has the right mean. */
static void test_representatives_have_the_mean_of_all(void **state)
{
    (void)state;
    double all = light_of_strip("estimator=vpl:lights=1000,visibility=rays,compensation=0");
    double one = light_of_strip("estimator=lightcuts:most_clusters=1,compensation=0");
    double four = light_of_strip("estimator=lightcuts:most_clusters=4,compensation=0");
    print_message("by one light of all %.4f of their light, by four %.4f\n", one / all, four / all);
    assert_true(fabs(one / all - 1) < 0.04);
    assert_true(fabs(four / all - 1) < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_maps_agree_with_shadow_rays),
        cmocka_unit_test(test_convex_objects_do_not_shadow_themselves),
        cmocka_unit_test(test_finest_cuts_are_all_lights),
        SLOW_TEST(test_large_maps),
        SLOW_TEST(test_representatives_have_the_mean_of_all),
        SLOW_TEST(test_cuts_grow_slower_than_lights),
    };
    return RUN_TESTS(tests);
}
