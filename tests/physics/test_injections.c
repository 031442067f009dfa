/* test_injections.c: the pictures that other injections than `photon` make of the Cornell box:
 * their mean against path tracing, and independence of threads and batches. Their photons alone are
 * the subject of tests/unit/test_injection_*.c.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define WIDTH 96
#define HEIGHT 54
#define SMALL_SPLATS "visibility=shadowmap:radius=10,resolution=8"

static const char *const channels[] = {"indirect.R", "indirect.G", "indirect.B"};

/* The Cornell box in several passes: its section `render` comes last. The caller frees it. */
static char *text_of_passes(int passes)
{
    char *text = cornell_text(WIDTH, HEIGHT);
    size_t length = strlen(text);
    text = realloc(text, length + 64);
    assert_non_null(text);
    snprintf(text + length, 64, "\n  passes: %d\n", passes);
    return text;
}

static void mean(const char *text, const char *const choices[], double colour[3])
{
    struct rendering rendering = render_text(text, 2, choices);
    for (int k = 0; k < 3; k++)
        colour[k] = mean_of_all(&rendering.image, channels[k]);
    rendering_release(&rendering);
}

static void test_mean_is_that_of_path_tracing(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        const char *const choices[6];
        double bias;
        int passes;
    } methods[] = {
        {"photon, splats", {"injection=photon:count=300000", SMALL_SPLATS, NULL}, 0.02, 1},
        {"rsm, splats", {"injection=rsm:count=300000", SMALL_SPLATS, NULL}, 0.02, 1},
        {"rsm of 32 pixels, 16 passes",
         {"injection=rsm:count=300000,resolution=32", SMALL_SPLATS, NULL},
         0.02,
         16},
        {"rsm, photon map",
         {"injection=rsm:count=200000", "estimator=photonmap:neighbours=60", NULL},
         0.03,
         1},
        {"rsm, virtual lights, 8 passes",
         {"injection=rsm:count=2048", "estimator=vpl:lights=2048,clamp=5", NULL},
         0.02,
         8},
        {"voxel of 256, 8 passes", {"injection=voxel:resolution=256", SMALL_SPLATS, NULL}, 0.02, 8},
        {"voxel of 128, 16 passes",
         {"injection=voxel:resolution=128", SMALL_SPLATS, NULL},
         0.02,
         16},
        {"voxel of 16 cells, 64 passes",
         {"injection=voxel:resolution=16", SMALL_SPLATS, NULL},
         0.04,
         64},
        {"voxel, virtual lights",
         {"injection=voxel:resolution=32", "estimator=vpl:lights=100000,clamp=5", NULL},
         0.03,
         1},
    };
    static const char *const reference[] = {"estimator=pathtrace:samples=512", "bounces=1", NULL};
    char *text = cornell_text(WIDTH, HEIGHT);
    double truth[3], colour[3];
    mean(text, reference, truth);
    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        char *passes = text_of_passes(methods[i].passes);
        mean(passes, methods[i].choices, colour);
        free(passes);
        print_message("%-28s mean / path tracing %.4f %.4f %.4f, allowed %.1f %%\n",
                      methods[i].name, colour[0] / truth[0], colour[1] / truth[1],
                      colour[2] / truth[2], 100 * methods[i].bias);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(colour[k] / truth[k] - 1) < methods[i].bias);
    }
    free(text);
}

static void test_threads_and_batches_change_nothing(void **state)
{
    (void)state;
    static const char *const injections[] = {"injection=rsm:count=20000",
                                             "injection=voxel:resolution=100"};
    char *text = cornell_text(WIDTH, HEIGHT);
    for (int i = 0; i < 2; i++) {
        const char *const choices[] = {injections[i], "stratification=grid", NULL};
        struct rendering one = render_text(text, 1, choices);
        struct rendering three = render_text_in_batches(text, 3, 17, choices);
        for (int k = 0; k < 3; k++)
            assert_memory_equal(image_channel(&one.image, channels[k]),
                                image_channel(&three.image, channels[k]),
                                WIDTH * HEIGHT * sizeof(float));
        rendering_release(&one);
        rendering_release(&three);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SLOW_TEST(test_mean_is_that_of_path_tracing),
        cmocka_unit_test(test_threads_and_batches_change_nothing),
    };
    return RUN_TESTS(tests);
}
