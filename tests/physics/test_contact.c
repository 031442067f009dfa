/* test_contact.c: the variance that estimators tell where a wall meets the floor, and what the
 * denoiser makes of it: shadows as narrow as a pixel.
 */
#include "pipeline/stages.h"
#include "support/lit_floor.h"
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 96
#define HEIGHT 64

static const char wall[] = LIT_FLOOR("location: [0, 1.5, 4], look_at: [0, 0.2, 0], angle: 30", "");

static const char *const estimators[] = {"estimator=gather:samples=16",
                                         "estimator=final_gather:samples=16",
                                         "estimator=pathtrace:samples=16"};

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
static void expect_variance(const char *estimator)
{
    enum { RENDERS = 24 };
    const char *const strategies[] = {estimator, "denoiser=none", NULL};
    double expected = 0, found = 0;
    int pixels = 0;
    memset(told, 0, sizeof told);
    for (int seed = 1; seed <= RENDERS; seed++) {
        char text[2048];
        snprintf(text, sizeof text, "%srender: {bounces: all, passes: 1, seed: %d}\n", wall, seed);
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
    print_message("%s: %d pixels in contact, variance told %.2f times what it is\n", estimator,
                  pixels, expected / found);
    assert_true(pixels > WIDTH / 4);
    assert_true(expected > 0.9 * found && expected < 6 * found);
}

static void test_variance_in_contact(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof estimators / sizeof estimators[0]; i++)
        expect_variance(estimators[i]);
}

/* Studs as wide as a pixel stand out of a wall, each below a pixel from which it hides the lit
 * floor. */
#define STUDS                                                                                      \
    "  - for: i\n"                                                                                 \
    "    from: 0\n"                                                                                \
    "    to: 9\n"                                                                                  \
    "    do: [box: {corners: [[\"=0.08 * i - 0.4\", 1.28, 0.0005], [\"=0.08 * i - 0.38\", 1.299, " \
    "0.02]], material: dark}]\n"

static const char studs[] =
    LIT_FLOOR("location: [0, 1.3, 4], look_at: [0, 1.3, 0], angle: 27", ", dark: {diffuse: 0.1}")
        STUDS "render: {bounces: all, passes: 1}\n";

/* The mean light of the pixels that are so many above a stud. */
static double light_above_studs(const char *estimator, const char *denoiser, size_t pixels)
{
    const char *const strategies[] = {estimator, denoiser, NULL};
    struct rendering rendering = render_text(studs, 2, strategies);
    double mean = 0;
    for (size_t i = 0; i < 10; i++)
        mean += mean_of(&rendering.image, "indirect.G", 28 + 4 * i, 31 - pixels, 1, 1) / 10;
    rendering_release(&rendering);
    return mean;
}

static void test_narrow_shadows_stay(void **state)
{
    (void)state;
    double shadow = light_above_studs("estimator=pathtrace:samples=1024", "denoiser=none", 0);
    double lit = light_above_studs("estimator=pathtrace:samples=1024", "denoiser=none", 3);
    print_message("the shadow has %.3f of the light above\n", shadow / lit);
    assert_true(shadow < 0.2 * lit);
    for (size_t i = 0; i < 2; i++) { /* with so few samples paths do not know it */
        double found = light_above_studs(estimators[i], "denoiser=regression", 0);
        print_message("%s: %.3f\n", estimators[i], found / lit);
        assert_true(found < 0.7 * lit);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_variance_in_contact),
        cmocka_unit_test(test_narrow_shadows_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
