/* test_guided_gather.c: gather rays drawn where those before them found light, and how both are
 * combined.
 *
 * A wall that no lamp reaches sees a small lit patch of the floor: by the cosine one ray in ten
 * finds it. Where the wall meets the floor, the variance of what is found is told.
 */
#include "pipeline/stages.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#define WIDTH 96
#define HEIGHT 64
#define SEEDS 4

#define WALL(LOOK_AT)                                                                              \
    "psd: 1\n"                                                                                     \
    "camera: {location: [0, 1.5, 4], look_at: " LOOK_AT ", angle: 30}\n"                           \
    "image: {width: 96, height: 64}\n"                                                             \
    "materials: {white: {diffuse: 0.7}}\n"                                                         \
    "lights: [spotlight: {location: [0, 3, 1.2], point_at: [0, 0, 1.2], radius: 12, falloff: 14, " \
    "intensity: 100}]\n"                                                                           \
    "objects:\n"                                                                                   \
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, 0], [-9, 0, 0]], material: white}\n"       \
    "  - quad: {corners: [[-9, 0, 0], [9, 0, 0], [9, 9, 0], [-9, 9, 0]], material: white}\n"

static const char scene[] = WALL("[0, 1.3, 0]"), foot[] = WALL("[0, 0.2, 0]");

static struct rendering render_by(const char *estimator, int seed)
{
    const char *const strategies[] = {estimator, "denoiser=none", NULL};
    char text[2048];
    snprintf(text, sizeof text, "%srender: {bounces: 1, passes: 1, seed: %d}\n", scene, seed);
    return render_text(text, 2, strategies);
}

static double grain_by(const char *estimator)
{
    struct rendering rendering = render_by(estimator, 1);
    double grain = grain_of(&rendering.image, "indirect.G", 1, 1, WIDTH - 2, HEIGHT - 2);
    rendering_release(&rendering);
    return grain;
}

/* Four rays by the cosine, and as many guided ones, whose noise is a fifth. As plain means of all
 * eight they would have half of the noise of the four. */
static void test_guided_rays_count_by_their_pdf(void **state)
{
    (void)state;
    double unguided = grain_by("estimator=gather:samples=4,adaptive=no");
    double both = grain_by("estimator=gather:samples=8,adaptive=no");
    double shared_out = grain_by("estimator=gather:samples=8,adaptive=yes");
    print_message("noise %.3f, with guided rays %.3f, shared out %.3f\n", unguided, both,
                  shared_out);
    assert_true(unguided > 1.0);
    assert_true(both < 0.38 * unguided);
    assert_true(shared_out < 0.38 * unguided);
}

/* A ball across the edge of its shade, in one tile: the patch of floor that lights it lies below
 * the horizon of half of the pixels. */
static const char ball[] =
    "psd: 1\n"
    "camera: {location: [0, 2, 6], look_at: [0.25, 1.75, 0.93], angle: 8}\n"
    "image: {width: 32, height: 32}\n"
    "materials: {white: {diffuse: 0.7}}\n"
    "lights: [spotlight: {location: [2, 1, 0], point_at: [2, 0, 0], radius: 12, falloff: 14, "
    "intensity: 100}]\n"
    "objects:\n"
    "  - quad: {corners: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: white}\n"
    "  - sphere: {center: [0, 2, 0], radius: 1, material: white}\n"
    "render: {bounces: 1, passes: 1}\n";

/* Rays of a guide that faced as the first pixel does would find all light of some pixels by the
 * cosine alone. */
static void test_guides_of_bent_surfaces(void **state)
{
    (void)state;
    static const char *const strategies[] = {"estimator=gather:samples=64", "denoiser=none", NULL};
    struct rendering rendering = render_text(ball, 2, strategies);
    double grain = grain_of(&rendering.image, "indirect.G", 1, 1, 30, 30);
    print_message("noise at the edge of a ball's shade: %.3f\n", grain);
    assert_true(grain < 2.2);
    rendering_release(&rendering);
}

static double mean_by(const char *estimator, int seed)
{
    struct rendering rendering = render_by(estimator, seed);
    double mean = mean_of_all(&rendering.image, "indirect.G");
    rendering_release(&rendering);
    return mean;
}

/* Weights that follow from what the weighed rays found must not darken or brighten the light. */
static void test_weights_keep_the_mean(void **state)
{
    (void)state;
    double reference = mean_by("estimator=pathtrace:samples=512", 100);
    static const char *const estimators[] = {"estimator=gather:samples=8",
                                             "estimator=gather:samples=32,adaptive=no"};
    for (size_t i = 0; i < 2; i++) {
        double mean = 0;
        for (int seed = 1; seed <= SEEDS; seed++)
            mean += mean_by(estimators[i], seed) / SEEDS;
        print_message("%s: %.4f of the light\n", estimators[i], mean / reference);
        assert_true(fabs(mean / reference - 1) < 5e-3);
    }
}

/* Sums over renders, of a pixel whose variance each of them told. */
struct told {
    double sum, squares, variance;
    int count;
};

static struct told told[WIDTH * HEIGHT];

/* Something is near where floor and wall are no farther than a pixel is wide: 0.025. */
static void add_told(const ps_tile *tile, uint32_t lane, struct told *of)
{
    float sum = tile->irradiance_r[lane] + tile->irradiance_g[lane] + tile->irradiance_b[lane];
    double light = (double)sum / 3;
    if (!(tile->variance[lane] > 0))
        return;
    assert_true(tile->position_y[lane] < 0.04f && tile->position_z[lane] < 0.04f);
    of->sum += light;
    of->squares += light * light;
    of->variance += (double)tile->variance[lane];
    of->count++;
}

static ps_result look(void *user, struct render *render, struct error *error)
{
    (void)user;
    ps_result result = render_estimate(render, error);
    for (uint32_t tile = 0; tile < render->gbuffer.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            if (gbuffer_pixel(&render->gbuffer, tile, lane, &x, &y))
                add_told(&render->gbuffer.tiles[tile], lane, &told[y * WIDTH + x]);
        }
    return result;
}

/* It is that of many renders, or more: rays are stratified, and the tile's mean counts at least. */
static void test_variance_in_contact(void **state)
{
    enum { RENDERS = 24 };
    static const char *const strategies[] = {"estimator=gather:samples=16", "denoiser=none", NULL};
    double expected = 0, found = 0;
    int pixels = 0;
    (void)state;
    for (int seed = 1; seed <= RENDERS; seed++) {
        char text[2048];
        snprintf(text, sizeof text, "%srender: {bounces: all, passes: 1, seed: %d}\n", foot, seed);
        inspect_text(text, strategies, look, NULL);
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double n = told[i].count;
        if (n < RENDERS / 2)
            continue;
        found += (told[i].squares - told[i].sum * told[i].sum / n) / (n - 1);
        expected += told[i].variance / n;
        pixels++;
    }
    print_message("%d pixels in contact: variance told %.3f times what it is\n", pixels,
                  expected / found);
    assert_true(pixels > WIDTH / 4);
    assert_true(expected > 0.9 * found && expected < 4 * found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_guided_rays_count_by_their_pdf),
        cmocka_unit_test(test_guides_of_bent_surfaces),
        cmocka_unit_test(test_weights_keep_the_mean),
        cmocka_unit_test(test_variance_in_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
