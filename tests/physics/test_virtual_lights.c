/* test_virtual_lights.c: what maps over hemispheres hide of virtual lights is what shadow rays hide of them.
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

#define WIDTH 96
#define HEIGHT 54
#define ACROSS 6 /* blocks of pixels that are compared, as a whole each */
#define DOWN 3

static struct rendering render(const char *text, const char *estimator)
{
    const char *const choices[] = {"injection=photon:count=2000", estimator, NULL};
    return render_text(text, 2, choices);
}

/* The most that blocks differ from those of the other picture, relatively. */
static double largest_difference(const struct image *image, const struct image *reference)
{
    const size_t width = WIDTH / ACROSS, height = HEIGHT / DOWN;
    double largest = 0;
    for (size_t y = 0; y + height <= HEIGHT; y += height)
        for (size_t x = 0; x + width <= WIDTH; x += width) {
            double expected = mean_of(reference, "indirect.G", x, y, width, height);
            double found = mean_of(image, "indirect.G", x, y, width, height);
            if (expected > 0)
                largest = fmax(largest, fabs(found / expected - 1));
        }
    return largest;
}

static void test_maps_agree_with_shadow_rays(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    struct rendering rays = render(text, "estimator=vpl:visibility=rays");
    struct rendering map = render(text, "estimator=vpl:visibility=map");
    struct rendering none = render(text, "estimator=vpl:visibility=none");
    double of_map = largest_difference(&map.image, &rays.image);
    double of_none = largest_difference(&none.image, &rays.image);
    print_message("off by up to %.2f %%; without visibility %.0f %%\n", 100 * of_map,
                  100 * of_none);
    assert_true(of_map < 0.02);
    assert_true(of_none > 0.2);
    rendering_release(&rays);
    rendering_release(&map);
    rendering_release(&none);
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

/* However coarse the map is: the points of a cell that the object lies in are those of several of its sides. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_maps_agree_with_shadow_rays),
        cmocka_unit_test(test_convex_objects_do_not_shadow_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
