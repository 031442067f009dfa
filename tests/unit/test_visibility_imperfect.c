/* test_visibility_imperfect.c: maps of points against maps of rays. */
#include "support/render_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define PHOTONS "injection=photon:count=4000"

/* A floor lit by way of the ceiling, and a plate close above it, seen from below the plate. */
static const char plate_text[] =
    "psd: 1\n"
    "camera: {location: [0, 0.45, 6], look_at: [0, 0.15, 0], angle: 50}\n"
    "image: {width: 64, height: 36}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights:\n"
    "  - spotlight: {location: [0, 3, 0], point_at: [0, 4, 0], radius: 60, falloff: 60,\n"
    "                intensity: 100}\n"
    "objects:\n"
    "  - quad: {corners: [[-5, 0, -5], [5, 0, -5], [5, 0, 5], [-5, 0, 5]], material: white}\n"
    "  - quad: {corners: [[-5, 4, -5], [5, 4, -5], [5, 4, 5], [-5, 4, 5]], material: white}\n"
    "  - quad: {corners: [[-1.5, 1, -1.5], [1.5, 1, -1.5], [1.5, 1, 1.5], [-1.5, 1, 1.5]],\n"
    "           material: white}\n";

static struct rendering render(const char *text, const char *visibility)
{
    const char *const choices[] = {PHOTONS, visibility, NULL};
    return render_text(text, 2, choices);
}

static double relative_rms(const struct image *reference, const struct image *test)
{
    const float *a = image_channel(reference, "indirect.G");
    const float *b = image_channel(test, "indirect.G");
    size_t n = reference->width * reference->height;
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += ((double)b[i] - a[i]) * ((double)b[i] - a[i]);
    return sqrt(sum / (double)n) / mean_of_all(reference, "indirect.G");
}

static void test_converges_to_shadow_maps(void **state)
{
    (void)state;
    char *cornell = cornell_text(64, 36);
    static const char *const many = "injection=photon:count=40000";
    const char *const exact[] = {many, "visibility=shadowmap:radius=50,boundary_correction=no",
                                 NULL};
    struct rendering reference = render_text(cornell, 2, exact);
    double before = INFINITY, ratio = 0;
    for (int points = 1000; points <= 100000; points *= 10) {
        char visibility[96];
        snprintf(visibility, sizeof visibility,
                 "visibility=imperfect:radius=50,points=%d,boundary_correction=no", points);
        const char *const choices[] = {many, visibility, NULL};
        struct rendering rendering = render_text(cornell, 2, choices);
        double now = relative_rms(&reference.image, &rendering.image);
        ratio = mean_of_all(&rendering.image, "indirect.G") /
                mean_of_all(&reference.image, "indirect.G");
        print_message("%7d points: RMS %.4f, mean %.4f of shadowmap's\n", points, now, ratio);
        assert_true(now < 0.65 * before);
        before = now;
        rendering_release(&rendering);
    }
    assert_true(before < 0.035);
    assert_true(fabs(ratio - 1) < 0.01);
    rendering_release(&reference);
    free(cornell);
}

static void test_threads_and_batches_change_nothing(void **state)
{
    (void)state;
    const char *const choices[] = {PHOTONS, "visibility=imperfect:radius=0.5,points=5000", NULL};
    struct rendering one = render_text_in_batches(plate_text, 1, 4096, choices);
    struct rendering two = render_text_in_batches(plate_text, 3, 77, choices);
    size_t bytes = one.image.width * one.image.height * sizeof(float);
    assert_true(mean_of_all(&one.image, "indirect.G") > 0);
    assert_memory_equal(image_channel(&one.image, "indirect.G"),
                        image_channel(&two.image, "indirect.G"), bytes);
    rendering_release(&one);
    rendering_release(&two);
}

/* Mean light of the floor below the plate, and in the open. */
struct floor_light {
    double below, open;
};

static struct floor_light floor_light(const char *visibility)
{
    struct rendering rendering = render(plate_text, visibility);
    const float *x = image_channel(&rendering.image, "P.X");
    const float *y = image_channel(&rendering.image, "P.Y");
    const float *z = image_channel(&rendering.image, "P.Z");
    const float *light = image_channel(&rendering.image, "indirect.G");
    double sums[2] = {0, 0}, counts[2] = {0, 0};
    for (size_t i = 0; i < rendering.image.width * rendering.image.height; i++) {
        float reach = fmaxf(fabsf(x[i]), fabsf(z[i]));
        if (!(fabsf(y[i]) < 1e-3f) || (reach > 0.8f && reach < 2.5f) || reach > 4)
            continue;
        sums[reach > 1] += light[i];
        counts[reach > 1]++;
    }
    assert_true(counts[0] > 20 && counts[1] > 20);
    rendering_release(&rendering);
    struct floor_light result = {sums[0] / counts[0], sums[1] / counts[1]};
    print_message("%s: %.5f below, %.4f open\n", visibility, result.below, result.open);
    return result;
}

/* Few points, small texels: maps are full of holes. The box reaches from the plate to the floor. */
#define PLATE_BOX "radius=0.8,bandwidth_scale=0,step_back=auto,depth=2,resolution=16"

/* How many holes a set of points leaves is chance, so several are looked at. */
static void test_pull_push_fills_holes(void **state)
{
    (void)state;
    static const int points[] = {800, 1000, 1500, 2000, 3000};
    struct floor_light map = floor_light("visibility=shadowmap:" PLATE_BOX);
    double open_below = 0, filled_below = 0;
    for (int i = 0; i < 5; i++) {
        char text[2][160];
        for (int k = 0; k < 2; k++)
            snprintf(text[k], sizeof text[k],
                     "visibility=imperfect:" PLATE_BOX ",points=%d,pull=%d", points[i], 3 * k);
        struct floor_light open = floor_light(text[0]), filled = floor_light(text[1]);
        assert_true(open.below > map.below && filled.below < open.below);
        assert_true(fabs(filled.open / map.open - 1) < 0.05);
        open_below += open.below;
        filled_below += filled.below;
    }
    assert_true(filled_below < 0.75 * open_below);
}

static void test_points_are_counted(void **state)
{
    (void)state;
    struct rendering rendering = render(plate_text, "visibility=imperfect:points=12345");
    assert_true(statistics_counter(&rendering.statistics, "visibility points") == 12345);
    assert_true(statistics_bytes(&rendering.statistics, "visibility points") > 12345 * 24);
    rendering_release(&rendering);
}

/* Two small surfaces far apart: lines through the sphere around them hardly ever meet one. */
static void test_hardly_any_surface(void **state)
{
    (void)state;
    static const char text[] =
        "psd: 1\n"
        "camera: {location: [0, 1, 3], look_at: [0, 0, 0], angle: 50}\n"
        "image: {width: 16, height: 9}\n"
        "materials: {white: {diffuse: 0.7}}\n"
        "lights: [{point: {location: [0, 1, 0], intensity: 10}}]\n"
        "objects:\n"
        "  - quad: {corners: [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], material: white}\n"
        "  - quad: {corners: [[-1, 0, 900], [1, 0, 900], [1, 0, 902], [-1, 0, 902]],\n"
        "           material: white}\n";
    struct rendering rendering = render(text, "visibility=imperfect:points=1000");
    assert_true(statistics_counter(&rendering.statistics, "visibility points") < 1000);
    rendering_release(&rendering);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SLOW_TEST(test_converges_to_shadow_maps),
        cmocka_unit_test(test_threads_and_batches_change_nothing),
        cmocka_unit_test(test_pull_push_fills_holes),
        cmocka_unit_test(test_points_are_counted),
        cmocka_unit_test(test_hardly_any_surface),
    };
    return RUN_TESTS(tests);
}
