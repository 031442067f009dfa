/* test_convergence.c: pictures come closer to those of the reference strategy as the resolution of
 * an approximate one grows: stratifications to `none`, visibilities to `raycast`, injections to
 * `photon`. That fine cells merge nothing at all is the subject of test_merging.c.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define MOST_STEPS 4

/* The same light paths for all, where they are by photons. */
#define PHOTONS "injection=photon:count=8000,split=1"

struct approximation {
    const char *reference[3];
    const char *steps[MOST_STEPS]; /* from coarse to fine */
    double last;                   /* the finest one's error at most, noise and all */
    double bias;                   /* and how far off its mean may be */
};

static struct rendering render(const char *text, const char *const fixed[], const char *choice)
{
    const char *const choices[] = {choice, fixed[0], fixed[1], NULL};
    return render_text(text, 2, choices);
}

/* RMS of the difference over the reference's mean, in green. */
static double distance(const struct image *reference, const struct image *test)
{
    const float *a = image_channel(reference, "indirect.G");
    const float *b = image_channel(test, "indirect.G");
    size_t n = reference->width * reference->height;
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += pow((double)b[i] - (double)a[i], 2);
    return sqrt(sum / (double)n) / mean_of_all(reference, "indirect.G");
}

/* How far the mean of the second is off that of the first. */
static double bias(const struct image *reference, const struct image *test)
{
    return fabs(mean_of_all(test, "indirect.G") / mean_of_all(reference, "indirect.G") - 1);
}

static void expect_convergence(const struct approximation *approximation)
{
    char *text = cornell_text(64, 36);
    const char *const *fixed = approximation->reference + 1;
    struct rendering reference = render(text, fixed, approximation->reference[0]);
    double before = INFINITY, off = INFINITY;
    for (int i = 0; i < MOST_STEPS && approximation->steps[i]; i++) {
        struct rendering test = render(text, fixed, approximation->steps[i]);
        double now = distance(&reference.image, &test.image);
        off = bias(&reference.image, &test.image);
        print_message("%-56s %.4f, mean off by %.4f\n", approximation->steps[i], now, off);
        assert_true(now < 0.8 * before);
        before = now;
        rendering_release(&test);
    }
    assert_true(before < approximation->last && off < approximation->bias);
    rendering_release(&reference);
    free(text);
}

/* Splats of one size, or those of what was merged would be larger ones. */
#define EVEN "visibility=shadowmap:max_merge_scale=1"

static void test_stratifications_converge_to_none(void **state)
{
    (void)state;
    static const struct approximation approximations[] = {
        {{"stratification=none", PHOTONS, EVEN},
         {"stratification=grid:resolution=32", "stratification=grid:resolution=128",
          "stratification=grid:resolution=512", "stratification=grid:resolution=2048"},
         0.03,
         0.003},
        {{"stratification=none", PHOTONS, EVEN},
         {"stratification=cascade:resolution=64", "stratification=cascade:resolution=256",
          "stratification=cascade:resolution=1024", "stratification=cascade:resolution=4096"},
         0.03,
         0.003},
        {{"stratification=none", PHOTONS, EVEN},
         {"stratification=octree:capacity=64", "stratification=octree:capacity=16",
          "stratification=octree:capacity=4", "stratification=octree:capacity=1"},
         0.03,
         0.003},
    };
    for (size_t i = 0; i < sizeof approximations / sizeof approximations[0]; i++)
        expect_convergence(&approximations[i]);
}

static void test_visibilities_converge_to_raycast(void **state)
{
    (void)state;
    static const struct approximation approximations[] = {
        {{"visibility=raycast:radius=30,boundary_correction=no", PHOTONS, "stratification=none"},
         {"visibility=shadowmap:radius=30,boundary_correction=no,resolution=2",
          "visibility=shadowmap:radius=30,boundary_correction=no,resolution=8",
          "visibility=shadowmap:radius=30,boundary_correction=no,resolution=32"},
         0.02,
         0.005},
        {{"visibility=raycast:radius=30,boundary_correction=no", PHOTONS, "stratification=none"},
         {"visibility=imperfect:radius=30,boundary_correction=no,points=1000,resolution=4",
          "visibility=imperfect:radius=30,boundary_correction=no,points=20000,resolution=8",
          "visibility=imperfect:radius=30,boundary_correction=no,points=200000,resolution=16"},
         0.05,
         0.01},
    };
    for (size_t i = 0; i < sizeof approximations / sizeof approximations[0]; i++)
        expect_convergence(&approximations[i]);
}

static void test_injections_converge_to_photon(void **state)
{
    (void)state;
    static const struct approximation approximations[] = {
        {{"injection=photon:count=60000", "visibility=none:radius=50", "stratification=none"},
         {"injection=rsm:count=60000,resolution=2", "injection=rsm:count=60000,resolution=8",
          "injection=rsm:count=60000,resolution=128"},
         0.15,
         0.01},
        {{"injection=photon:count=60000", "visibility=none:radius=50", "stratification=none"},
         {"injection=voxel:resolution=8", "injection=voxel:resolution=32",
          "injection=voxel:resolution=128"},
         0.35,
         0.01},
    };
    for (size_t i = 0; i < sizeof approximations / sizeof approximations[0]; i++)
        expect_convergence(&approximations[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stratifications_converge_to_none),
        SLOW_TEST(test_visibilities_converge_to_raycast),
        cmocka_unit_test(test_injections_converge_to_photon),
    };
    return RUN_TESTS(tests);
}
