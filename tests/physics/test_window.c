/* test_window.c: a room that the sky lights through its window alone. Its floor's light is that of
 * the window seen as a polygon (Lambert 1760), with little noise, since rays go through the window
 * (direct/portals.h); and on matt surfaces as on gloss, which weighs the sky that was asked against
 * the sky that was hit, it has the mean that it has without.
 */
#include "support/reflected_light.h"
#include "support/render_scene.h"
#include "trace/trace.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define PI 3.14159265358979323846
#define SEEDS 8
#define ALBEDO 0.5

/* The window is 2 m wide and 1.2 m high. What is outside of the walls hides nothing of the sky. */
static const char room_text[] =
    "psd: 1\n"
    "camera: {location: [0, 2.8, -2.5], look_at: [0, 0, 0], angle: 60}\n"
    "image: {width: %d, height: %d}\n"
    "materials:\n"
    "  matt: {diffuse: 0.5}\n"
    "  gloss: {glossy: {diffuse: 0.2, specular: 0.6, roughness: 0.3}}\n"
    "lights:\n"
    "  - sky: {radiance: 1}\n"
    "objects:\n"
    "  - box: {corners: [[-3, -1, -4], [3, 0, 3]], material: %s}\n"
    "  - box: {corners: [[-3, 3, -4], [3, 4, 3]], material: matt}\n"
    "  - box: {corners: [[-3, 0, -4], [-2, 3, 3]], material: matt}\n"
    "  - box: {corners: [[2, 0, -4], [3, 3, 3]], material: matt}\n"
    "  - box: {corners: [[-2, 0, -4], [2, 3, -3]], material: matt}\n"
    "  - box: {corners: [[-2, 0, 3], [2, 1, 3.001]], material: matt}\n"
    "  - box: {corners: [[-2, 2.2, 3], [2, 3, 3.001]], material: matt}\n"
    "  - box: {corners: [[-2, 1, 3], [-1, 2.2, 3.001]], material: matt}\n"
    "  - box: {corners: [[1, 1, 3], [2, 2.2, 3.001]], material: matt}\n"
    "render: {bounces: 1, aa_samples: 1, light_samples: 1, seed: %d}\n";

/* --- the closed form --- */

/* Irradiance of a point of the floor, of a sky of radiance 1: half the sum of the angles of the
 * window's edges times the cosines of their planes' normals. */
static double irradiance_of_floor(double x, double z)
{
    static const double corners[4][2] = {{-1, 1}, {1, 1}, {1, 2.2}, {-1, 2.2}};
    double sum = 0.0;
    for (int i = 0; i < 4; i++) {
        const double *here = corners[i], *next = corners[(i + 1) % 4];
        double a[3] = {here[0] - x, here[1], 3 - z}, b[3] = {next[0] - x, next[1], 3 - z};
        double across = a[2] * b[0] - a[0] * b[2]; /* the upright part of a x b */
        double normal[3] = {a[1] * b[2] - a[2] * b[1], across, a[0] * b[1] - a[1] * b[0]};
        double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        double angle = atan2(length, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
        sum += angle * across / length;
    }
    return 0.5 * fabs(sum);
}

/* Of the floor's pixels: the mean of their light over that of the closed form, and the variance of
 * a pixel, over the square of its light. */
struct floor_light {
    double ratio, variance, cosine_variance;
};

static struct floor_light measure(int seed)
{
    static const char *const choices[] = {"estimator=ambient:irradiance=0", NULL};
    char text[4096];
    snprintf(text, sizeof text, room_text, 64, 64, "matt", seed);
    struct rendering rendering = render_text(text, 2, choices);
    const struct image *image = &rendering.image;
    const float *x = image_channel(image, "P.X"), *y = image_channel(image, "P.Y");
    const float *z = image_channel(image, "P.Z"), *light = image_channel(image, "direct.G");
    struct floor_light sum = {0, 0, 0};
    double count = 0;
    assert_true(x && y && z && light);
    for (size_t i = 0; i < image->width * image->height; i++) {
        if (!(fabsf(y[i]) < 1e-3f && fabsf(z[i]) < 2.9f))
            continue;
        double irradiance = irradiance_of_floor((double)x[i], (double)z[i]);
        double ratio = (double)light[i] * PI / ALBEDO / irradiance;
        count += 1;
        sum.ratio += ratio;
        sum.variance += (ratio - 1) * (ratio - 1);
        sum.cosine_variance += PI / irradiance - 1;
    }
    assert_true(count > 1000);
    rendering_release(&rendering);
    return (struct floor_light){sum.ratio / count, sum.variance / count,
                                sum.cosine_variance / count};
}

static void test_floor_under_a_window(void **state)
{
    (void)state;
    double ratios[SEEDS], variance = 0.0, cosine_variance = 0.0;
    for (int i = 0; i < SEEDS; i++) {
        struct floor_light light = measure(i + 1);
        ratios[i] = light.ratio;
        variance += light.variance / SEEDS;
        cosine_variance = light.cosine_variance;
    }
    expect_estimate("floor under a window", estimate_of(ratios, SEEDS), 1.0, 0.002);
    print_message("variance of a ray: %.2f, of one by the cosine %.2f\n", variance,
                  cosine_variance);
    assert_true(variance < 0.2 * cosine_variance);
}

/* --- with and without portals --- */

/* A portal that is a little larger than the window, on the box of the room. */
static void make_portals(struct portals *portals)
{
    const struct portal_bins window = {{2, true}, {15, 20}, {49, 48}};
    portals_begin(portals, (ps_vec3){-2.001f, -0.001f, -3.001f}, (ps_vec3){2.001f, 3.001f, 3.001f});
    portals_add(portals, &window);
}

static void expect_same_mean(const char *material)
{
    char text[4096];
    struct trace *trace;
    struct error error;
    struct portals portals;
    snprintf(text, sizeof text, room_text, 16, 16, material, 1);
    struct scene scene = scene_of_text(text);
    assert_int_equal(trace_create(&scene, NULL, &trace, &error), PS_OK);
    make_portals(&portals);
    struct lighting lighting = {.scene = &scene, .trace = trace, .choices = scene.light_choices};
    struct estimate by_sky = reflected_light(&lighting);
    lighting.portals = &portals;
    struct estimate by_portals = reflected_light(&lighting);
    trace_destroy(trace);
    scene_release(&scene);
    expect_agreement(material, by_portals, by_sky, 0.002);
    assert_true(by_portals.standard_error < 0.5 * by_sky.standard_error);
}

static void test_matt_surface(void **state)
{
    (void)state;
    expect_same_mean("matt");
}

static void test_gloss(void **state)
{
    (void)state;
    expect_same_mean("gloss");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_floor_under_a_window),
        cmocka_unit_test(test_matt_surface),
        cmocka_unit_test(test_gloss),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
