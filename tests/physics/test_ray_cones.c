/* test_ray_cones.c: a hit by a cone has the mean colour of the picture, or of the procedural noise,
 * over the cone's width, whatever the surface: a picture of noise, looked up at many places, varies
 * as little as its means over squares of that width.
 */
#include "base/sample.h"
#include "image/image.h"
#include "support/render_scene.h"
#include "trace/trace.h"
#include "unit/scratch.h"
#include <math.h>
#include <psplat/math.h>

#define SIDE 256
#define PLACES 400
#define MEMBERS 64 /* rays of a mean */

/* The picture's texels are about 0.0156 wide on the first one; they all lie around (0, 0, 0) and
 * face +z. The features of `marble` are 0.1 wide, and less. */
static const char scene_text[] =
    "psd: 1\n"
    "camera: {location: [0, 0, 9], look_at: [0, 0, 0], angle: 40}\n"
    "image: {width: 16, height: 16}\n"
    "materials:\n"
    "  once: {diffuse: {image: {file: %s, encoding: linear}}}\n"
    "  often: {diffuse: {image: {file: %s, encoding: linear, repeat: [2, 8]}}}\n"
    "  holes: {diffuse: {image: {file: %s, encoding: linear}}, opacity: {image: {file: %s}}}\n"
    "  gloss: {glossy: {diffuse: {image: {file: %s, encoding: linear}}, specular: 0.04, roughness: "
    "0.5}}\n"
    "  marble: {diffuse: {noise: {colors: [0.1, 0.9], octaves: 3, scale: 0.1}}}\n"
    "  both: {diffuse: {noise: {colors: [0.1, 0.9], scale: 0.01}}, bump: {image: {file: %s}}}\n"
    "groups:\n"
    "  panel: [{quad: {corners: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], material: "
    "once}}]\n"
    "  slab: [{quad: {corners: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], material: "
    "marble}}]\n"
    "objects:\n"
    "  - %s\n";

static const char quad[] =
    "quad: {corners: [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], material: %s%s}";

static void write_noise(const char *path)
{
    static uint8_t rgb[SIDE * SIDE * 3];
    struct error error;
    for (uint64_t i = 0; i < SIDE * SIDE; i++)
        memset(rgb + 3 * i, (int)(sample_hash(i) & 255), 3);
    assert_int_equal(image_write_png(path, SIDE, SIDE, rgb, NULL, 0, &error), PS_OK);
}

/* Down from above (x, y), slanted by (lean, 0). */
static ps_ray ray_onto(float x, float y, float lean)
{
    ps_vec3 direction = ps_normalize((ps_vec3){lean, 0, -1});
    ps_vec3 target = {x, y, 0};
    return (ps_ray){ps_add_scaled(target, -5.0f, direction), 0.0f, direction, INFINITY};
}

static ps_hit hit_of(const struct trace *trace, ps_ray ray, float spread)
{
    ps_hit hit;
    trace_intersect(trace, RAYS_INCOHERENT, &ray, &spread, 1, &hit);
    assert_true(hit.distance < INFINITY);
    return hit;
}

/* The mean over parallel rays of a square of that width across them. */
static float mean_of_square(const struct trace *trace, float x, float y, float width, float lean)
{
    double sum = 0.0;
    for (uint64_t i = 0; i < MEMBERS; i++) {
        float numbers[4];
        sample_point(sample_key(3, PS_STREAM_VIEW, 0), i, numbers);
        float across = (numbers[0] - 0.5f) * width * sqrtf(1.0f + lean * lean);
        ps_ray ray = ray_onto(x + across, y + (numbers[1] - 0.5f) * width, lean);
        sum += (double)hit_of(trace, ray, 0.0f).albedo.g;
    }
    return (float)(sum / MEMBERS);
}

struct moments {
    double mean, deviation;
};

static struct moments moments_of(const float *values)
{
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < PLACES; i++) {
        sum += (double)values[i];
        squares += (double)values[i] * (double)values[i];
    }
    double mean = sum / PLACES;
    return (struct moments){mean, sqrt(fmax(squares / PLACES - mean * mean, 0.0))};
}

static void expect_means(const struct trace *trace, const char *name, float spread, float lean)
{
    float filtered[PLACES], averaged[PLACES];
    for (uint64_t i = 0; i < PLACES; i++) {
        float numbers[4];
        sample_point(sample_key(1, PS_STREAM_VIEW, 0), i, numbers);
        float x = numbers[0] - 0.5f, y = numbers[1] - 0.5f;
        ps_hit hit = hit_of(trace, ray_onto(x, y, lean), spread);
        filtered[i] = hit.albedo.g;
        averaged[i] = mean_of_square(trace, x, y, spread * hit.distance, lean);
    }
    struct moments a = moments_of(filtered), b = moments_of(averaged);
    double ratio = a.deviation / b.deviation;
    print_message("%s: spread %g: %.3f +- %.4f; means over squares: %.3f +- %.4f\n", name,
                  (double)spread, a.mean, a.deviation, b.mean, b.deviation);
    /* Interpolation between texels of that width takes in more: a tent of noise varies 2/3 as much
     * as a box. */
    if (!(ratio > 0.45 && ratio < 1.3) || !(fabs(a.mean / b.mean - 1.0) < 0.03))
        fail_msg("%s: they differ", name);
}

/* Calls back with the ray tracer of a scene with that object; `texel`: about how wide its texels
 * are. */
static void with_object(void **state, const char *object, const char *name, float texel,
                        void (*body)(const struct trace *trace, const char *name, float texel))
{
    char text[4096];
    const char *path = scratch_path(state, "noise.png");
    struct trace *trace;
    struct error error;
    write_noise(path);
    snprintf(text, sizeof text, scene_text, path, path, path, path, path, path, object);
    struct scene scene = scene_of_text(text);
    assert_int_equal(trace_create(&scene, NULL, &trace, &error), PS_OK);
    body(trace, name, texel);
    trace_destroy(trace);
    scene_release(&scene);
}

/* Widths of 2 to 10 texels. */
static void expect_all_spreads(const struct trace *trace, const char *name, float texel)
{
    static const float spreads[] = {0.5f, 1.0f, 2.5f};
    for (size_t i = 0; i < sizeof spreads / sizeof spreads[0]; i++)
        expect_means(trace, name, spreads[i] * texel, 0.0f);
}

static void test_surfaces(void **state)
{
    static const struct {
        const char *name, *material, *more;
        float texel;
    } quads[] = {{"quad", "once", "", 0.0156f},
                 {"repeated", "often", "", 0.0039f},
                 {"gloss", "gloss", "", 0.0156f},
                 {"placed", "once", ", scale: [3, 0.5, 1]", 0.0191f},
                 {"noise", "marble", "", 0.01f}};
    for (size_t i = 0; i < sizeof quads / sizeof quads[0]; i++) {
        char object[512];
        snprintf(object, sizeof object, quad, quads[i].material, quads[i].more);
        with_object(state, object, quads[i].name, quads[i].texel, expect_all_spreads);
    }
}

static void test_instance(void **state)
{
    with_object(state, "instance: {of: panel, rotate: [0, 0, 30], scale: [1.5, 3, 1]}", "instance",
                0.0331f, expect_all_spreads);
    with_object(state, "instance: {of: slab, rotate: [0, 0, 30], scale: 2}", "instance of noise",
                0.02f, expect_all_spreads);
}

static void test_sphere(void **state)
{
    with_object(state, "sphere: {center: [0, 0, -3], radius: 3, material: once}", "sphere", 0.04f,
                expect_all_spreads);
}

/* Slanted, a mean over the cone's width across leaves the longer way of its section unfiltered: as
 * sharp or sharper. */
static void expect_sharpness(const struct trace *trace, const char *name, float texel)
{
    float straight[PLACES], slanted[PLACES];
    float spread = 1.3f * texel;
    for (uint64_t i = 0; i < PLACES; i++) {
        float numbers[4];
        sample_point(sample_key(1, PS_STREAM_VIEW, 0), i, numbers);
        float x = numbers[0] - 0.5f, y = numbers[1] - 0.5f;
        straight[i] = hit_of(trace, ray_onto(x, y, 0.0f), spread).albedo.g;
        slanted[i] = hit_of(trace, ray_onto(x, y, 3.0f), spread).albedo.g;
    }
    double ratio = moments_of(slanted).deviation / moments_of(straight).deviation;
    if (fabs(ratio - 1.0) > 0.05)
        fail_msg("%s: slanted, it varies %g times as much", name, ratio);
}

static void test_slanted(void **state)
{
    char object[512];
    snprintf(object, sizeof object, quad, "once", "");
    with_object(state, object, "quad", 0.0156f, expect_sharpness);
}

/* Colours beside holes are no part of the surface. */
static void expect_point(const struct trace *trace, const char *name, float texel)
{
    (void)texel;
    for (int i = 0; i < 20; i++) {
        ps_ray ray = ray_onto(0.07f * (float)i - 0.6f, 0.31f, 0.0f);
        float spread = 0.04f;
        ps_hit cone, line;
        trace_intersect(trace, RAYS_INCOHERENT, &ray, &spread, 1, &cone);
        trace_intersect(trace, RAYS_INCOHERENT, &ray, NULL, 1, &line);
        assert_int_equal(cone.flags, line.flags);
        if (line.distance < INFINITY && cone.albedo.g != line.albedo.g)
            fail_msg("%s: it is filtered", name);
    }
}

/* Widths by a picture's coordinates say nothing about the noise beside it. */
static void expect_same_colour(const struct trace *trace, const char *name, float texel)
{
    for (int i = 0; i < 20; i++) {
        ps_ray ray = ray_onto(0.07f * (float)i - 0.6f, 0.31f, 0.0f);
        if (hit_of(trace, ray, 2.5f * texel).albedo.g != hit_of(trace, ray, 0.0f).albedo.g)
            fail_msg("%s: it is filtered", name);
    }
}

static void test_noise_beside_picture(void **state)
{
    char object[512];
    snprintf(object, sizeof object, quad, "both", "");
    with_object(state, object, "noise beside a picture", 0.0156f, expect_same_colour);
}

static void test_holes(void **state)
{
    char object[512];
    snprintf(object, sizeof object, quad, "holes", "");
    with_object(state, object, "holes", 0.0156f, expect_point);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_surfaces), SCRATCH_TEST(test_instance),
        SCRATCH_TEST(test_sphere),   SCRATCH_TEST(test_slanted),
        SCRATCH_TEST(test_holes),    SCRATCH_TEST(test_noise_beside_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
