/* test_light_threshold.c: light below the threshold (scene/light_bvh.h), which few points ask for,
 * has the mean that it has where all ask: on matt surfaces, and on gloss, which weighs lights that
 * were drawn against lights that were hit.
 */
#include "support/reflected_light.h"
#include "support/render_scene.h"
#include "trace/trace.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

/* A lamp beside the surface, and a row of small ones. */
static const char scene_text[] =
    "psd: 1\n"
    "camera: {location: [0, 2, 5], look_at: [0, 0, 0], angle: 40}\n"
    "image: {width: 16, height: 16}\n"
    "materials:\n"
    "  matt: {diffuse: 0.7}\n"
    "  gloss: {glossy: {diffuse: 0.2, specular: 0.6, roughness: 0.3}}\n"
    "  bright: {diffuse: 0, emission: 40}\n"
    "  dim: {diffuse: 0, emission: 10}\n"
    "objects:\n"
    "  - box: {corners: [[-3, -0.1, -3], [3, 0, 3]], material: %s}\n"
    "  - sphere: {center: [-2, 0.5, -2], radius: 0.1, material: bright}\n"
    "  - for: i\n"
    "    from: 0\n"
    "    to: 7\n"
    "    do:\n"
    "      sphere: {center: ['=0.5*i-2', 2, -3], radius: 0.06, material: dim}\n";

static struct estimate estimate_with(const char *material, float threshold)
{
    char text[2048];
    struct trace *trace;
    struct error error;
    snprintf(text, sizeof text, scene_text, material);
    struct scene scene = scene_of_text(text);
    assert_int_equal(trace_create(&scene, NULL, &trace, &error), PS_OK);
    const struct lighting lighting = {
        .scene = &scene,
        .trace = trace,
        .choices = scene.light_choices,
        .light_threshold = threshold,
    };
    struct estimate light = reflected_light(&lighting);
    trace_destroy(trace);
    scene_release(&scene);
    return light;
}

static void expect_same_mean(const char *material)
{
    static const float thresholds[] = {0.02f, 0.1f, 0.3f};
    struct estimate all = estimate_with(material, 0.0f);
    for (int i = 0; i < 3; i++)
        expect_agreement(material, estimate_with(material, thresholds[i]), all, 0.002);
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
        cmocka_unit_test(test_matt_surface),
        cmocka_unit_test(test_gloss),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
