/* test_energy.c: splatted light against light gathered by brute force.
 *
 * The gather is written here, on nothing but the ray tracer: at a pixel, many cosine-distributed
 * rays, and at each hit the light that arrives there straight from the lamps. Its mean over pixels
 * spread over the picture is compared with the splatted layer's mean over the same pixels.
 */
#include "base/sample.h"
#include "direct/direct.h"
#include "support/render_scene.h"
#include "trace/trace.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define WIDTH 96
#define HEIGHT 54
#define STEP 3 /* every third pixel in x and y */
#define RAYS 256

/* The scene's light has no size. */
static const struct light_numbers no_numbers = {0};

/* Single-bounce radiance that pixel (x, y) reflects, green channel. */
static double gather(const struct scene *scene, const struct trace *trace, size_t x, size_t y)
{
    ps_ray eye = camera_ray(&scene->camera, (float)x + 0.5f, (float)y + 0.5f, NULL), rays[RAYS];
    ps_hit first, hits[RAYS];
    trace_intersect(trace, RAYS_INCOHERENT, &eye, NULL, 1, &first);
    if (!(first.distance < INFINITY))
        return 0;
    uint32_t key = sample_key(99, 77, (uint32_t)(y * WIDTH + x));
    ps_vec3 origin = ps_add_scaled(first.position, scene->surface_offset, first.normal);
    for (size_t i = 0; i < RAYS; i++) {
        float u[4];
        sample_point(key, i, u);
        rays[i] = (ps_ray){origin, 0, ps_cosine_direction(first.normal, u[0], u[1]), INFINITY};
    }
    trace_intersect(trace, RAYS_INCOHERENT, rays, NULL, RAYS, hits);
    struct lighting lighting = {.scene = scene, .trace = trace, .choices = scene->light_choices};
    double sum = 0;
    for (size_t i = 0; i < RAYS; i++) {
        ps_rgb radiance;
        if (!(hits[i].distance < INFINITY))
            continue;
        direct_radiance(&lighting, &rays[i], &hits[i], NULL, 1, &no_numbers, &radiance);
        sum += first.albedo.g * radiance.g;
    }
    return sum / RAYS;
}

static double gather_all(const char *text)
{
    struct scene scene = scene_of_text(text);
    struct trace *trace;
    struct error error;
    assert_int_equal(trace_create(&scene, NULL, &trace, &error), PS_OK);
    double sum = 0;
    for (size_t y = 1; y < HEIGHT; y += STEP)
        for (size_t x = 1; x < WIDTH; x += STEP)
            sum += gather(&scene, trace, x, y);
    trace_destroy(trace);
    scene_release(&scene);
    return sum;
}

static double splat_all(const char *text, const char *visibility)
{
    const char *const choices[] = {
        "injection=photon:count=300000,split=1", "bounces=1", visibility, "filter=tent",
        "estimator=splat:gather_rays=0",         NULL};
    struct rendering rendering = render_text(text, 2, choices);
    const float *green = image_channel(&rendering.image, "indirect.G");
    double sum = 0;
    for (size_t y = 1; y < HEIGHT; y += STEP)
        for (size_t x = 1; x < WIDTH; x += STEP)
            sum += green[y * WIDTH + x];
    rendering_release(&rendering);
    return sum;
}

static void test_converges_to_the_gather(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    double truth = gather_all(text);
    double large =
        splat_all(text, "visibility=shadowmap:step_back=auto,radius=40,resolution=8") / truth;
    double medium =
        splat_all(text, "visibility=shadowmap:step_back=auto,radius=20,resolution=8") / truth;
    double small =
        splat_all(text, "visibility=shadowmap:step_back=auto,radius=10,resolution=8") / truth;
    print_message("splatted / gathered: %.4f %.4f %.4f at 40, 20, 10 mm\n", large, medium, small);
    assert_true(fabs(small - 1.0) < 0.03);
    assert_true(fabs(medium - 1.0) < 0.04);
    assert_true(1.0 - large > 1.0 - medium && 1.0 - medium > 1.0 - small);
    free(text);
}

static void test_full_beams_keep_the_energy(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    double ratio = splat_all(text, "visibility=shadowmap:step_back=full,radius=10,resolution=8") /
                   gather_all(text);
    print_message("full bundles: splatted / gathered %.4f\n", ratio);
    assert_true(fabs(ratio - 1.0) < 0.03);
    free(text);
}

/* What walls beside the photons keep back is most of what large bundles lose. */
static void test_walls_give_back_what_creases_lose(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    double truth = splat_all(text, "visibility=shadowmap:radius=8,resolution=4,bandwidth_scale=0");
    double lost =
        splat_all(text, "visibility=shadowmap:radius=50,boundary_correction=no") / truth - 1;
    double left =
        splat_all(text, "visibility=shadowmap:radius=50,boundary_correction=yes") / truth - 1;
    print_message("bundles of 50 mm against 8: %+.4f, making up for walls %+.4f\n", lost, left);
    assert_true(lost < -0.02);
    assert_true(fabs(left) < 0.5 * fabs(lost));
    free(text);
}

/* The thesis's fixed step-back loses light that does not come back as the maps shrink: the finding
 * that made `auto`. */
static void test_fixed_step_back_loses_energy(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    double truth = gather_all(text);
    double fixed =
        splat_all(text, "visibility=shadowmap:step_back=20,radius=20,resolution=8,bias=2,"
                        "depth=20") /
        truth;
    double by_slope =
        splat_all(text, "visibility=shadowmap:step_back=auto,radius=20,resolution=8") / truth;
    print_message("fixed step-back: %.4f, auto: %.4f\n", fixed, by_slope);
    assert_true(fixed < by_slope - 0.02);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SLOW_TEST(test_converges_to_the_gather),
        cmocka_unit_test(test_full_beams_keep_the_energy),
        SLOW_TEST(test_walls_give_back_what_creases_lose),
        cmocka_unit_test(test_fixed_step_back_loses_energy),
    };
    return RUN_TESTS(tests);
}
