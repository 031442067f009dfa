/* test_light_threshold.c: light below the threshold (scene/light_bvh.h), which few points ask for, has the mean that it has
 * where all ask: on matt surfaces, and on gloss, which weighs lights that were drawn against lights that were hit.
 */
#include "base/sample.h"
#include "direct/direct.h"
#include "support/render_scene.h"
#include "support/statistics_of.h"
#include "trace/trace.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define SEEDS 8
#define RAYS 64
#define TURNS 400 /* of each ray */

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

/* Radiance that the surfaces that some camera rays meet send back of all lamps, by lamps that they ask and by rays that they
 * scatter. */
static double reflected(const struct lighting *lighting, uint64_t seed)
{
    const struct scene *scene = lighting->scene;
    double sum = 0.0;
    for (uint64_t i = 0; i < (uint64_t)RAYS * TURNS; i++) {
        float x = 4.0f + (float)(i % RAYS % 8), y = 8.0f + 0.5f * (float)(i % RAYS / 8);
        ps_ray eye = camera_ray(&scene->camera, x, y, NULL), on;
        ps_hit hit, met;
        ps_rgb asked, emitted;
        float numbers[4];
        const struct light_numbers from = {seed, PS_STREAM_LIGHT, 0, &i};
        trace_intersect(lighting->trace, RAYS_INCOHERENT, &eye, NULL, 1, &hit);
        direct_radiance(lighting, &eye, &hit, 1, &from, &asked);
        sum += (double)asked.g;
        sample_point(sample_key(seed, PS_STREAM_PATH, 0), i, numbers);
        ps_bsdf_sample scattered =
            material_scatter(&scene->materials[hit.material], scene->microfacets, PS_FROM_CAMERA,
                             &eye, &hit, numbers);
        if (scattered.lobe == PS_DIFFUSE)
            continue;
        on = ps_leave_surface(hit.position, scattered.normal, scattered.direction,
                              scene->surface_offset);
        trace_intersect(lighting->trace, RAYS_INCOHERENT, &on, NULL, 1, &met);
        emitted_radiance(lighting, &on, &met, &scattered.pdf, 1, &emitted);
        sum += (double)(scattered.weight.g * emitted.g);
    }
    return sum / (RAYS * TURNS);
}

static struct estimate estimate_with(const char *material, float threshold)
{
    char text[2048];
    double values[SEEDS];
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
    for (int i = 0; i < SEEDS; i++)
        values[i] = reflected(&lighting, (uint64_t)i + 1);
    trace_destroy(trace);
    scene_release(&scene);
    return estimate_of(values, SEEDS);
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
