/* test_camera.c: what cameras, lenses and pixel filters make of a disc of radius r and radiance 1
 * on black, which lies across the view at distance z.
 *
 * The mean of the picture is the disc's share of it: of width w and height h at distance z, pi r^2
 * / (w h). A lens of radius a that is focused at distance f turns each point of the disc's edge
 * into a disc of radius b = a |z - f| / f, measured where the disc lies: full light up to r - b,
 * none from r + b on, and in focus what a pinhole shows. All points of the lens see the disc
 * equally large, so that the mean stays; it also stays with any pixel filter.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define WIDTH 64
#define HEIGHT 48
#define RADIUS 0.5

static const char scene[] =
    "psd: 1\n"
    "%s\n"
    "image: {width: 64, height: 48, filter: %s}\n"
    "materials: {shining: {diffuse: 0, emission: 1}}\n"
    "objects:\n"
    "  - disc: {center: [0, 0, 0], normal: [0, 0, 1], radius: 0.5, segments: 512,\n"
    "           material: shining}\n"
    "render: {passes: 64}\n";

static struct rendering look(const char *camera, const char *filter)
{
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    char text[2048];
    snprintf(text, sizeof text, scene, camera, filter);
    return render_text(text, 2, choices);
}

static void expect_mean(const char *camera, const char *filter, double width)
{
    struct rendering rendering = look(camera, filter);
    double expected = PI * RADIUS * RADIUS / (width * width * HEIGHT / WIDTH);
    double mean = mean_of_all(&rendering.image, "G");
    print_message("%s, %s: mean / expected %.5f\n", camera, filter, mean / expected);
    assert_true(fabs(mean / expected - 1) < 0.005);
    rendering_release(&rendering);
}

#define PINHOLE "camera: {location: [0, 0, 4], look_at: [0, 0, 0], angle: 30}"
#define FOCUSED "camera: {location: [0, 0, 4], look_at: [0, 0, 0], angle: 30, aperture: 0.3}"
#define BLURRED                                                                                    \
    "camera: {location: [0, 0, 4], look_at: [0, 0, 0], angle: 30, aperture: 0.3, focus: 3}"
#define PARALLEL                                                                                   \
    "camera: {location: [0, 0, %d], look_at: [0, 0, 0], projection: orthographic, width: 2}"

static double bandwidth_at(double distance)
{
    return 2 * distance * tan(15 * PI / 180);
}

static void test_size_in_perspective(void **state)
{
    (void)state;
    expect_mean(PINHOLE, "box", bandwidth_at(4));
    expect_mean("camera: {location: [0, 0, 2.5], look_at: [0, 0, 0], angle: 30}", "box",
                bandwidth_at(2.5));
    expect_mean("camera: {location: [0, 0, 4], look_at: [0, 0, 0], vertical_angle: 30}", "box",
                bandwidth_at(4) * WIDTH / HEIGHT);
}

static void test_size_in_parallel(void **state)
{
    (void)state;
    char near[160], far[160];
    snprintf(near, sizeof near, PARALLEL, 1);
    snprintf(far, sizeof far, PARALLEL, 50);
    expect_mean(near, "box", 2);
    expect_mean(far, "box", 2);
}

static void test_first_camera_counts(void **state)
{
    (void)state;
    static const char other[] = "{location: [0, 0, 9], look_at: [0, 1, 0], angle: 60}";
    char text[512];
    snprintf(text, sizeof text,
             "cameras: {one: {location: [0, 0, 4], look_at: [0, 0, 0], angle: 30}, two: %s}",
             other);
    expect_mean(text, "box", bandwidth_at(4));
    snprintf(text, sizeof text, "cameras: {one: %s}\n" PINHOLE, other);
    expect_mean(text, "box", bandwidth_at(4));
}

static void test_lens_keeps_the_mean(void **state)
{
    (void)state;
    expect_mean(FOCUSED, "box", bandwidth_at(4));
    expect_mean(BLURRED, "box", bandwidth_at(4));
}

static void test_focus_is_sharp(void **state)
{
    (void)state;
    struct rendering sharp = look(PINHOLE, "box"), focused = look(FOCUSED, "box");
    const float *a = image_channel(&sharp.image, "G"), *b = image_channel(&focused.image, "G");
    double worst = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        worst = fmax(worst, fabs((double)a[i] - (double)b[i]));
    print_message("in focus: worst pixel off by %.4f\n", worst);
    assert_true(worst < 0.05); /* one of 64 passes at an edge by rounding, and some more */
    rendering_release(&sharp);
    rendering_release(&focused);
}

/* Of a pixel from the middle of the picture, in the plane of the disc. */
static double distance_of(size_t x, size_t y)
{
    double pixel = bandwidth_at(4) / WIDTH;
    return hypot((double)x + 0.5 - WIDTH / 2.0, (double)y + 0.5 - HEIGHT / 2.0) * pixel;
}

static void test_blur(void **state)
{
    (void)state;
    struct rendering rendering = look(BLURRED, "box");
    double blur = 0.3 / 3, pixel = bandwidth_at(4) / WIDTH, between = 0;
    size_t count = 0;
    for (size_t y = 0; y < HEIGHT; y++)
        for (size_t x = 0; x < WIDTH; x++) {
            double distance = distance_of(x, y), value = mean_of(&rendering.image, "G", x, y, 1, 1);
            if (distance < RADIUS - blur - pixel)
                assert_true(fabs(value - 1) < 1e-4);
            if (distance > RADIUS + blur + pixel)
                assert_true(value == 0);
            if (fabs(distance - RADIUS) < 0.25 * pixel) {
                between += value;
                count++;
            }
        }
    /* At the edge itself nearly half of the lens sees the disc. */
    print_message("out of focus: %.3f at the edge\n", between / (double)count);
    assert_true(fabs(between / (double)count - 0.47) < 0.05);
    rendering_release(&rendering);
}

static size_t soft_pixels(const char *filter)
{
    struct rendering rendering = look(PINHOLE, filter);
    size_t count = 0;
    for (size_t y = 0; y < HEIGHT; y++)
        for (size_t x = 0; x < WIDTH; x++) {
            double value = mean_of(&rendering.image, "G", x, y, 1, 1);
            count += value > 0.02 && value < 0.98;
        }
    rendering_release(&rendering);
    return count;
}

static void test_pixel_filters(void **state)
{
    (void)state;
    expect_mean(PINHOLE, "tent", bandwidth_at(4));
    expect_mean(PINHOLE, "gaussian", bandwidth_at(4));
    size_t box = soft_pixels("box"), tent = soft_pixels("tent");
    size_t gaussian = soft_pixels("gaussian");
    print_message("soft pixels: box %zu, tent %zu, gaussian %zu\n", box, tent, gaussian);
    assert_true(tent > box && gaussian > box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_size_in_perspective), cmocka_unit_test(test_size_in_parallel),
        cmocka_unit_test(test_first_camera_counts), cmocka_unit_test(test_lens_keeps_the_mean),
        cmocka_unit_test(test_focus_is_sharp),      cmocka_unit_test(test_blur),
        cmocka_unit_test(test_pixel_filters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
