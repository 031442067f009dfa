/* test_ambient_occlusion.c: the estimators `ssao` and `hbao` against their formulas in a crease,
 * against plain ambient light where nothing occludes, and `hbao` against ray-cast occlusion. */
#include "support/render_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define SIZE 64
#define CREASE_WIDTH 2.0 /* of what the picture shows of the crease, in scene units */

/* A floor and a wall that meet in the x axis, seen from far off at 45 degrees to both; all lengths
 * times `scale`. Albedo and irradiance are such that the picture shows visibility / pi. */
static void crease_text(char *text, size_t size, double scale, int passes)
{
    double far = 300 * scale, wide = 9 * scale;
    double degrees = 2 * atan(0.5 * CREASE_WIDTH / (300 * sqrt(2))) * 180 / 3.14159265358979;
    snprintf(text, size,
             "psd: 1\n"
             "camera: {location: [0, %g, %g], look_at: [0, 0, 0], angle: %.9g}\n"
             "image: {width: %d, height: %d}\n"
             "materials: {white: {diffuse: 1}}\n"
             "objects:\n"
             "  - quad: {corners: [[-%g, 0, 0], [%g, 0, 0], [%g, 0, %g], [-%g, 0, %g]],\n"
             "           material: white}\n"
             "  - quad: {corners: [[-%g, 0, 0], [%g, 0, 0], [%g, %g, 0], [-%g, %g, 0]],\n"
             "           material: white}\n"
             "render: {passes: %d}\n",
             far, far, degrees, SIZE, SIZE, wide, wide, wide, wide, wide, wide, wide, wide, wide,
             wide, wide, wide, passes);
}

static struct rendering render(const char *text, const char *estimator, uint32_t threads)
{
    const char *const choices[] = {estimator, NULL};
    return render_text(text, threads, choices);
}

static struct rendering render_crease(const char *estimator)
{
    char text[2048];
    crease_text(text, sizeof text, 1, 1);
    return render(text, estimator, 2);
}

static void expect_same_light(const char *text, const char *one, const char *other)
{
    static const char *const names[] = {"indirect.R", "indirect.G", "indirect.B", "weight"};
    struct rendering a = render(text, one, 1), b = render(text, other, 3);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_memory_equal(image_channel(&a.image, names[i]), image_channel(&b.image, names[i]),
                            a.image.width * a.image.height * sizeof(float));
    assert_true(mean_of_all(&a.image, "indirect.G") > 0);
    rendering_release(&a);
    rendering_release(&b);
}

/* --- where nothing occludes --- */

/* Two plates before a slanting wall, farther from it and from each other than the radius. */
static const char plates[] =
    "psd: 1\n"
    "camera: {location: [0, 0, 9], look_at: [0, 0, 0], angle: 50}\n"
    "image: {width: 100, height: 60}\n"
    "materials: {white: {diffuse: 0.7}, red: {diffuse: [0.6, 0, 0.1]}}\n"
    "objects:\n"
    "  - quad: {corners: [[-3, -9, -2], [3, -9, 0], [3, 9, 0], [-3, 9, -2]], material: white}\n"
    "  - quad: {corners: [[-1, -1, 1], [0, -1, 1], [0, 1, 1], [-1, 1, 1]], material: red}\n"
    "  - quad: {corners: [[0, -1, 2], [1, -1, 2], [1, 1, 2], [0, 1, 2]], material: white}\n"
    "render: {passes: 2}\n";

static void test_unoccluded_is_ambient(void **state)
{
    (void)state;
    static const char *const far_choices[] = {
        "estimator=ssao:irradiance=[2, 0.3, 1],radius=0.7",
        "estimator=hbao:irradiance=[2, 0.3, 1],radius=0.7",
        "estimator=hbao:irradiance=[2, 0.3, 1],radius=0.7,cosine=no",
    };
    static const char *const near_choices[] = {
        "estimator=ssao:radius=2.5",
        "estimator=hbao:radius=2.5",
        "estimator=hbao:radius=2.5,cosine=no",
    };
    struct rendering far = render(plates, "estimator=ambient", 1);
    for (int k = 0; k < 3; k++) {
        expect_same_light(plates, "estimator=ambient:irradiance=[2, 0.3, 1]", far_choices[k]);
        struct rendering near = render(plates, near_choices[k], 1);
        assert_true(mean_of_all(&near.image, "indirect.R") <
                    0.99 * mean_of_all(&far.image, "indirect.R"));
        rendering_release(&near);
    }
    rendering_release(&far);
}

static void test_intensity_zero_is_ambient(void **state)
{
    (void)state;
    char text[2048];
    crease_text(text, sizeof text, 1, 2);
    expect_same_light(text, "estimator=ambient", "estimator=ssao:radius=1,intensity=0");
}

/* --- the crease --- */

/* Of a point on the floor whose pixel is b0 below the crease on the picture plane: the mean over
 * the disc of what wall it shows, by midpoints. */
static double expected_of_ssao(double b0, double radius, double intensity)
{
    enum { GRID = 800 };
    double x = b0 * sqrt(2), sum = 0, e = 0.01 * radius * radius;
    for (int j = 0; j < GRID; j++)
        for (int i = 0; i < GRID; i++) {
            double a = ((2 * i + 1.0) / GRID - 1) * radius, b = ((2 * j + 1.0) / GRID - 1) * radius;
            double height = (b - b0) * sqrt(2), v2 = a * a + x * x + height * height;
            if (a * a + b * b < radius * radius && height > 0 && v2 < radius * radius)
                sum += height / (v2 + e) * (1 - v2 / (radius * radius));
        }
    double mean = sum * 4 / (3.14159265358979 * GRID * GRID);
    return fmax(0, 1 - 2 * intensity * radius * mean);
}

static double row_visibility(const struct image *image, size_t row)
{
    return 3.14159265358979 * mean_of(image, "indirect.G", 16, row, 32, 1);
}

static void test_crease_of_ssao(void **state)
{
    (void)state;
    static const double intensities[] = {1, 0.4};
    for (int k = 0; k < 2; k++) {
        char estimator[128];
        snprintf(estimator, sizeof estimator,
                 "estimator=ssao:radius=0.5,samples=2048,bias=1e-6,intensity=%g", intensities[k]);
        struct rendering rendering = render_crease(estimator);
        for (size_t row = SIZE / 2; row < SIZE; row += 3) {
            double b0 = ((double)row + 0.5 - SIZE / 2) * CREASE_WIDTH / SIZE;
            double expected = expected_of_ssao(b0, 0.5, intensities[k]);
            double got = row_visibility(&rendering.image, row);
            print_message("%.3f below the crease: %.4f, expected %.4f\n", b0, got, expected);
            assert_true(fabs(got - expected) < 0.015);
            assert_true(fabs(row_visibility(&rendering.image, SIZE - 1 - row) - expected) < 0.015);
        }
        rendering_release(&rendering);
    }
}

/* Of a point on the floor at a distance from the wall: what is left of the hemisphere, where the
 * wall occludes a direction whose part to the wall is c by 1 - (distance / (c radius))^2. By
 * midpoints; of all light alike in a closed form. */
static double expected_of_hbao(double distance, double radius, bool cosine)
{
    enum { STEPS = 4000 };
    double least = distance / radius, sum = 0;
    if (least >= 1)
        return 1;
    if (!cosine)
        return 1 - 0.5 * (1 - least) * (1 - least);
    for (int i = 0; i < STEPS; i++) {
        double c = least + (i + 0.5) * (1 - least) / STEPS;
        sum += (1 - least * least / (c * c)) * sqrt(1 - c * c);
    }
    return 1 - 2 / 3.14159265358979 * sum * (1 - least) / STEPS;
}

static void test_crease_of_hbao(void **state)
{
    (void)state;
    for (int cosine = 0; cosine < 2; cosine++) {
        char estimator[128];
        snprintf(estimator, sizeof estimator,
                 "estimator=hbao:radius=0.5,slices=64,steps=64,bias=0.1,cosine=%s",
                 cosine ? "yes" : "no");
        struct rendering rendering = render_crease(estimator);
        for (size_t row = SIZE / 2; row < SIZE; row += 3) {
            double b0 = ((double)row + 0.5 - SIZE / 2) * CREASE_WIDTH / SIZE;
            double expected = expected_of_hbao(b0 * sqrt(2), 0.5, cosine);
            double got = row_visibility(&rendering.image, row);
            print_message("%.3f below the crease: %.4f, expected %.4f\n", b0, got, expected);
            /* The pixels of the crease itself are as far from it as from each other. */
            double allowed = row == SIZE / 2 ? 0.05 : 0.015;
            assert_true(fabs(got - expected) < allowed);
            assert_true(fabs(row_visibility(&rendering.image, SIZE - 1 - row) - expected) <
                        allowed);
        }
        rendering_release(&rendering);
    }
}

/* Blocks on a floor under an even sky, seen from straight above: all that occludes is in the
 * picture. The sky is direct light, found by rays; its irradiance where nothing occludes is pi
 * times its radiance. */
static const char blocks[] =
    "psd: 1\n"
    "camera: {location: [0, 9, 0], look_at: [0, 0, 0], up: [0, 0, -1], projection: orthographic, "
    "width: 3}\n"
    "image: {width: 96, height: 96}\n"
    "materials: {white: {diffuse: 1}}\n"
    "lights:\n"
    "  - sky: {radiance: 1}\n"
    "objects:\n"
    "  - quad: {corners: [[-4, 0, -4], [-4, 0, 4], [4, 0, 4], [4, 0, -4]], material: white}\n"
    "  - box: {corners: [[-1, 0, -1], [-0.2, 0.8, 0]], material: white}\n"
    "  - box: {corners: [[0.2, 0, -0.6], [0.9, 0.3, 0.9]], material: white}\n"
    "  - box: {corners: [[-0.8, 0, 0.4], [-0.1, 1.4, 0.8]], material: white}\n"
    "render: {light_samples: 128}\n";

static void test_hbao_is_ray_cast_occlusion(void **state)
{
    (void)state;
    struct rendering rendering =
        render(blocks, "estimator=hbao:irradiance=3.14159265,radius=100,slices=16,steps=300", 2);
    double most = 0;
    for (size_t y = 0; y < 96; y += 12)
        for (size_t x = 0; x < 96; x += 12) {
            double cast = mean_of(&rendering.image, "direct.G", x, y, 12, 12);
            double found = mean_of(&rendering.image, "indirect.G", x, y, 12, 12);
            most = fmax(most, fabs(found - cast));
        }
    print_message("mean %.4f, by rays %.4f; blocks are off by up to %.4f\n",
                  mean_of_all(&rendering.image, "indirect.G"),
                  mean_of_all(&rendering.image, "direct.G"), most);
    assert_true(most < 0.015);
    assert_true(mean_of_all(&rendering.image, "direct.G") < 0.9);
    rendering_release(&rendering);
}

/* "1: a right-angled crease keeps about half of its light" */
static void test_crease_keeps_half(void **state)
{
    (void)state;
    struct rendering rendering = render_crease("estimator=ssao:radius=0.5,samples=512");
    double darkest = row_visibility(&rendering.image, SIZE / 2);
    print_message("in the crease: %.3f\n", darkest);
    assert_true(darkest > 0.4 && darkest < 0.7);
    rendering_release(&rendering);
}

/* Light falls with the radius, and past it the surface is as bright as ever. */
static void test_radius_is_the_reach(void **state)
{
    (void)state;
    static const double radii[] = {0.1, 0.25, 0.5, 1};
    double before = 1;
    for (int k = 0; k < 4; k++) {
        char estimator[128];
        snprintf(estimator, sizeof estimator, "estimator=ssao:samples=128,radius=%g", radii[k]);
        struct rendering rendering = render_crease(estimator);
        double mean = 3.14159265358979 * mean_of_all(&rendering.image, "indirect.G");
        print_message("radius %g: mean %.4f\n", radii[k], mean);
        assert_true(mean < before - 0.005);
        before = mean;
        const float *y = image_channel(&rendering.image, "P.Y");
        const float *z = image_channel(&rendering.image, "P.Z");
        const float *green = image_channel(&rendering.image, "indirect.G");
        float full = 0.318309886f;
        for (size_t i = 0; i < SIZE * SIZE; i++)
            if (y[i] > radii[k] || z[i] > radii[k])
                assert_true(fabsf(green[i] - full) < 1e-7f);
        rendering_release(&rendering);
    }
}

static void test_units_do_not_matter(void **state)
{
    (void)state;
    char small[2048], large[2048];
    crease_text(small, sizeof small, 0.125, 1);
    crease_text(large, sizeof large, 16, 1);
    struct rendering a = render(small, "estimator=ssao:samples=64", 2);
    struct rendering b = render(large, "estimator=ssao:samples=64", 2);
    double darkest = row_visibility(&a.image, SIZE / 2);
    assert_true(darkest < 0.8);
    for (size_t row = 0; row < SIZE; row++)
        assert_true(fabs(row_visibility(&a.image, row) - row_visibility(&b.image, row)) < 2e-3);
    rendering_release(&a);
    rendering_release(&b);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    char text[2048];
    crease_text(text, sizeof text, 1, 3);
    expect_same_light(text, "estimator=ssao:radius=0.5", "estimator=ssao:radius=0.5");
    expect_same_light(text, "estimator=hbao:radius=0.5", "estimator=hbao:radius=0.5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unoccluded_is_ambient),
        cmocka_unit_test(test_intensity_zero_is_ambient),
        cmocka_unit_test(test_crease_of_ssao),
        cmocka_unit_test(test_crease_of_hbao),
        cmocka_unit_test(test_hbao_is_ray_cast_occlusion),
        cmocka_unit_test(test_crease_keeps_half),
        cmocka_unit_test(test_radius_is_the_reach),
        cmocka_unit_test(test_units_do_not_matter),
        cmocka_unit_test(test_threads_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
