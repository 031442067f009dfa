/* test_visibility.c: raycast against geometry, shadow maps against raycast.
 *
 * The scenes' light comes from a small patch of ceiling, lit by a narrow spotlight from close by:
 * as good as a point, whose shadows are known. */
#include "support/render_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct rendering render(const char *text, const char *visibility, const char *injection)
{
    const char *const choices[] = {visibility, injection, "filter=box", NULL};
    return render_text(text, 2, choices);
}

/* --- raycast against geometry --- */

/* The patch lies at (1, 2, 0), and a plate at height 1 ends at x = 0: so the floor is dark up to
 * x = -1. Seen from below the plate. */
static const char edge_text[] =
    "psd: 1\n"
    "camera: {location: [-1, 0.9, 0.6], look_at: [-1, 0, 0], angle: 60}\n"
    "image: {width: 48, height: 27}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights: [{spotlight: {location: [1, 1.9, 0], point_at: [1, 2, 0], radius: 5, falloff: 5,\n"
    "                      intensity: 1000}}]\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], material: white}\n"
    "  - quad: {corners: [[-9, 2, -9], [9, 2, -9], [9, 2, 9], [-9, 2, 9]], material: white}\n"
    "  - quad: {corners: [[-9, 1, -9], [0, 1, -9], [0, 1, 9], [-9, 1, 9]], material: white}\n";

/* Where the light of the columns' means crosses half of its level in the open. */
static double edge_place(const struct image *image, double *pixel)
{
    size_t middle = image->height / 2 * image->width;
    const float *x = image_channel(image, "P.X") + middle;
    double open = mean_of(image, "indirect.G", image->width - 8, 8, 8, 11), before = 0;
    *pixel = fabs((double)x[1] - x[0]);
    for (size_t column = 0; column < image->width; column++) {
        double light = mean_of(image, "indirect.G", column, 8, 1, 11) / open;
        if (column > 0 && light >= 0.5)
            return x[column - 1] + (x[column] - x[column - 1]) * (0.5 - before) / (light - before);
        before = light;
    }
    fail_msg("no edge");
    return 0;
}

static void test_raycast_finds_a_hard_edge(void **state)
{
    (void)state;
    struct rendering rendering =
        render(edge_text, "visibility=raycast:radius=0.03,bandwidth_scale=0",
               "injection=photon:count=200000");
    const float *x = image_channel(&rendering.image, "P.X");
    const float *light = image_channel(&rendering.image, "indirect.G");
    double pixel, place = edge_place(&rendering.image, &pixel);
    print_message("edge at %.4f, a pixel is %.4f wide\n", place, pixel);
    assert_true(fabs(place + 1) < pixel);
    for (size_t i = 0; i < rendering.image.width * rendering.image.height; i++)
        assert_true(x[i] > -1.08f || light[i] == 0); /* a bundle is 3 cm wide at each side */
    rendering_release(&rendering);
}

/* --- raycast as a reference --- */

#define ROOM                                                                                       \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 0.45, 6], look_at: [0, 0.15, 0], angle: 50}\n"                         \
    "image: {width: 64, height: 36}\n"                                                             \
    "materials: {white: {diffuse: 0.7}}\n"                                                         \
    "lights:\n"                                                                                    \
    "  - spotlight: {location: [0, 3, 0], point_at: [0, 4, 0], radius: 60, falloff: 60,\n"         \
    "                intensity: 100}\n"                                                            \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], material: white}\n"     \
    "  - quad: {corners: [[-9, 4, -9], [9, 4, -9], [9, 4, 9], [-9, 4, 9]], material: white}\n"

static const char open_text[] = ROOM;
static const char plate_text[] =
    ROOM "  - quad: {corners: [[-1.5, 0.5, -1.5], [1.5, 0.5, -1.5], [1.5, 0.5, 1.5],\n"
         "                     [-1.5, 0.5, 1.5]], material: white}\n";
static const char turned_plate_text[] =
    ROOM "  - quad: {corners: [[-1.5, 0.5, 1.5], [1.5, 0.5, 1.5], [1.5, 0.5, -1.5],\n"
         "                     [-1.5, 0.5, -1.5]], material: white}\n";

#define PHOTONS "injection=photon:count=10000"

/* RMS of the difference in a channel over the reference's mean. */
static double relative_rms(const struct image *reference, const struct image *test,
                           const char *channel)
{
    const float *a = image_channel(reference, channel), *b = image_channel(test, channel);
    size_t n = reference->width * reference->height;
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += ((double)b[i] - a[i]) * ((double)b[i] - a[i]);
    return sqrt(sum / (double)n) / mean_of_all(reference, channel);
}

static double distance_to_raycast(const char *text, const char *raycast, const char *visibility)
{
    struct rendering reference = render(text, raycast, PHOTONS);
    struct rendering rendering = render(text, visibility, PHOTONS);
    double distance = relative_rms(&reference.image, &rendering.image, "indirect.G");
    print_message("%-50s differs from raycast by %.5f\n", visibility, distance);
    rendering_release(&reference);
    rendering_release(&rendering);
    return distance;
}

static void test_shadow_maps_converge_to_raycast(void **state)
{
    (void)state;
    double before = INFINITY;
    for (int resolution = 4; resolution <= 64; resolution *= 2) {
        char visibility[80];
        snprintf(visibility, sizeof visibility, "visibility=shadowmap:radius=0.5,resolution=%d",
                 resolution);
        double now = distance_to_raycast(plate_text, "visibility=raycast:radius=0.5", visibility);
        assert_true(now < 0.9 * before);
        before = now;
    }
    assert_true(before < 0.01);
}

static void test_no_visibility_agrees_where_nothing_is_in_the_way(void **state)
{
    (void)state;
    static const char *const raycast = "visibility=raycast:radius=0.5,step_back=auto";
    static const char *const none = "visibility=none:radius=0.5,step_back=auto";
    assert_true(distance_to_raycast(open_text, raycast, none) < 1e-5);
    assert_true(distance_to_raycast(plate_text, raycast, none) > 0.1);
}

static void test_rays_are_counted(void **state)
{
    (void)state;
    struct rendering exact = render(plate_text, "visibility=raycast:radius=0.5", PHOTONS);
    struct rendering map = render(plate_text, "visibility=shadowmap:radius=0.5", PHOTONS);
    double rays = statistics_counter(&exact.statistics, "visibility rays");
    double lit = statistics_counter(&exact.statistics, "pixel-splat tests with weight");
    print_message("%.0f rays, %.0f pairs lit\n", rays, lit);
    assert_true(lit > 0 && rays > lit);
    assert_true(statistics_counter(&map.statistics, "visibility rays") == 0);
    rendering_release(&exact);
    rendering_release(&map);
}

static void test_raycast_is_deterministic(void **state)
{
    (void)state;
    const char *const choices[] = {"visibility=raycast:radius=0.5", PHOTONS, NULL};
    struct rendering one = render_text_in_batches(plate_text, 1, 4096, choices);
    struct rendering two = render_text_in_batches(plate_text, 3, 77, choices);
    size_t bytes = one.image.width * one.image.height * sizeof(float);
    assert_memory_equal(image_channel(&one.image, "indirect.G"),
                        image_channel(&two.image, "indirect.G"), bytes);
    rendering_release(&one);
    rendering_release(&two);
}

/* --- shadow maps: back faces --- */

/* A sheet is hit from either side, whichever way it was built. */
static void test_sheets_have_two_sides(void **state)
{
    (void)state;
    struct rendering one = render(plate_text, "visibility=shadowmap:radius=0.5", PHOTONS);
    struct rendering two = render(turned_plate_text, "visibility=shadowmap:radius=0.5", PHOTONS);
    assert_true(relative_rms(&one.image, &two.image, "indirect.G") < 1e-5);
    rendering_release(&one);
    rendering_release(&two);
}

/* A patch at (0, 2, 0), and beside it a closed box from x = 0.05 on, from the ceiling down to half
 * the height: full bundles of half-width 0.3 start inside of it to a part, and that light must not
 * get out. Rays that start beside the box and pass below it end before x = 0.17. */
static const char inside_text[] =
    "psd: 1\n"
    "camera: {location: [0.7, 0.3, 1.5], look_at: [0.7, 0, 0], angle: 40}\n"
    "image: {width: 48, height: 27}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights: [{spotlight: {location: [0, 1.9, 0], point_at: [0, 2, 0], radius: 5, falloff: 5,\n"
    "                      intensity: 1000}}]\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], material: white}\n"
    "  - quad: {corners: [[-9, 2, -9], [9, 2, -9], [9, 2, 9], [-9, 2, 9]], material: white}\n"
    "  - box: {corners: [[0.05, 0.5, -3], [3, 2, 3]], material: white}\n";

static double light_below_the_box(const char *visibility)
{
    struct rendering rendering = render(inside_text, visibility, "injection=photon:count=50000");
    const float *x = image_channel(&rendering.image, "P.X");
    const float *y = image_channel(&rendering.image, "P.Y");
    const float *light = image_channel(&rendering.image, "indirect.G");
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < rendering.image.width * rendering.image.height; i++)
        if (fabsf(y[i]) < 1e-3f && x[i] > 0.4f && x[i] < 1) {
            sum += light[i];
            count++;
        }
    assert_true(count > 100);
    rendering_release(&rendering);
    print_message("%-50s %.2g below the box\n", visibility, sum / (double)count);
    return sum / (double)count;
}

static void test_light_that_starts_inside_a_box_stays_there(void **state)
{
    (void)state;
    assert_true(light_below_the_box("visibility=none:radius=0.3,bandwidth_scale=0,step_back=full") >
                1e-3);
    assert_true(light_below_the_box("visibility=raycast:radius=0.3,bandwidth_scale=0") == 0);
    assert_true(light_below_the_box(
                    "visibility=shadowmap:radius=0.3,bandwidth_scale=0,resolution=4") < 1e-6);
    assert_true(light_below_the_box(
                    "visibility=shadowmap:radius=0.3,bandwidth_scale=0,resolution=16") < 1e-6);
}

/* --- shadow maps: borders --- */

/* A slope below the patch, and nothing in the way: any map must leave all light there, up to the
 * disc's rim, where a pixel is half a texel or less from the wall of the box. */
static double weight_lost(const char *tilt, const char *visibility, const char *raycast)
{
    char text[2048];
    snprintf(text, sizeof text,
             "psd: 1\n"
             "camera: {location: [1, 1.8, 2], look_at: [0, 0, 0], angle: 25}\n"
             "image: {width: 48, height: 27}\n"
             "materials: {white: {diffuse: 0.7}}\n"
             "lights: [{spotlight: {location: [0, 1.9, 0], point_at: [0, 2, 0], radius: 5,\n"
             "                      falloff: 5, intensity: 1000}}]\n"
             "objects:\n"
             "  - quad: {corners: [[-9, 2, -9], [9, 2, -9], [9, 2, 9], [-9, 2, 9]],\n"
             "           material: white}\n"
             "  - quad: {corners: [[-1, 0, -2], [1, 0, -2], [1, 0, 2], [-1, 0, 2]],\n"
             "           material: white, rotate: [0, 0, %s]}\n",
             tilt);
    struct rendering reference = render(text, raycast, "injection=photon:count=20000");
    struct rendering rendering = render(text, visibility, "injection=photon:count=20000");
    double lost =
        1 - mean_of_all(&rendering.image, "weight") / mean_of_all(&reference.image, "weight");
    double rms = relative_rms(&reference.image, &rendering.image, "weight");
    print_message("tilt %s, %s: %.5f of the weight lost, RMS %.5f\n", tilt, visibility, lost, rms);
    rendering_release(&reference);
    rendering_release(&rendering);
    return fmax(fabs(lost), rms);
}

static void test_slopes_keep_their_weight_up_to_the_rim(void **state)
{
    (void)state;
    static const char *const tilts[] = {"0", "-40", "-65"};
    static const int resolutions[] = {1, 2, 3, 8};
    for (size_t t = 0; t < 3; t++)
        for (size_t r = 0; r < 4; r++) {
            char visibility[96];
            snprintf(
                visibility, sizeof visibility,
                "visibility=shadowmap:radius=0.15,bandwidth_scale=0,step_back=auto,resolution=%d",
                resolutions[r]);
            assert_true(
                weight_lost(tilts[t], visibility,
                            "visibility=raycast:radius=0.15,bandwidth_scale=0,step_back=auto") <
                1e-4);
        }
}

/* Edges seen against something farther away, and corners where the bundle sticks through the walls:
 * there a texel's ray misses the surface of some of its pixels. */
static void test_edges_and_corners_keep_their_light(void **state)
{
    (void)state;
    char *cornell = cornell_text(96, 54);
    struct rendering exact =
        render(cornell, "visibility=raycast:radius=50,boundary_correction=no", PHOTONS);
    struct rendering map = render(
        cornell, "visibility=shadowmap:radius=50,boundary_correction=no,resolution=4", PHOTONS);
    double ratio = mean_of_all(&map.image, "indirect.G") / mean_of_all(&exact.image, "indirect.G");
    double rms = relative_rms(&exact.image, &map.image, "indirect.G");
    print_message("Cornell box: 4x4 maps give %.4f of the light, RMS %.4f\n", ratio, rms);
    assert_true(fabs(ratio - 1) < 0.004);
    assert_true(rms < 0.05);
    rendering_release(&exact);
    rendering_release(&map);
    free(cornell);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_raycast_finds_a_hard_edge),
        cmocka_unit_test(test_shadow_maps_converge_to_raycast),
        cmocka_unit_test(test_no_visibility_agrees_where_nothing_is_in_the_way),
        cmocka_unit_test(test_rays_are_counted),
        cmocka_unit_test(test_raycast_is_deterministic),
        cmocka_unit_test(test_sheets_have_two_sides),
        cmocka_unit_test(test_light_that_starts_inside_a_box_stays_there),
        cmocka_unit_test(test_slopes_keep_their_weight_up_to_the_rim),
        cmocka_unit_test(test_edges_and_corners_keep_their_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
