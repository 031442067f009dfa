/* test_merging.c: what stratification does to the picture, and does not: the light of the Cornell
 * box stays, and so does independence of threads and batches.
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

#define WIDTH 100
#define HEIGHT 56
#define SEEDS 24

/* The Cornell box with a seed in its section `render`, which comes last. The caller frees it. */
static char *seeded(int seed)
{
    char *text = cornell_text(WIDTH, HEIGHT);
    size_t length = strlen(text);
    text = realloc(text, length + 64);
    assert_non_null(text);
    snprintf(text + length, 64, "\n  seed: %d\n", seed);
    return text;
}

static double light(const struct image *image)
{
    return mean_of_all(image, "indirect.R") + mean_of_all(image, "indirect.G") +
           mean_of_all(image, "indirect.B");
}

static struct rendering render_seed(int seed, const char *const choices[])
{
    char *text = seeded(seed);
    struct rendering rendering = render_text(text, 2, choices);
    free(text);
    return rendering;
}

#define SINGLE "injection=photon:count=25000,split=1"
#define SEVERAL "injection=photon:count=15000,split=1" /* and bounces */
#define FIXED "visibility=shadowmap:max_merge_scale=1"

static const char *bounces_with(const char *injection)
{
    return strcmp(injection, SINGLE) == 0 ? "bounces=1" : "bounces=4";
}

/* Light without stratification, seed by seed; rendered once for each injection. */
static const double *plain_light(const char *injection)
{
    static double lights[2][SEEDS];
    double *row = lights[strcmp(injection, SINGLE) == 0];
    const char *const choices[] = {injection, bounces_with(injection), NULL};
    for (int i = 0; i < SEEDS && !(row[SEEDS - 1] > 0); i++) {
        struct rendering rendering = render_seed(i + 1, choices);
        row[i] = light(&rendering.image);
        rendering_release(&rendering);
    }
    return row;
}

struct drift {
    double mean, standard_error; /* of light with stratification over light without, less 1 */
    double photons;              /* left, as a share of those injected */
};

/* Seed by seed, so that the noise that both have in common cancels. */
static struct drift drift_of(const char *injection, const char *stratification,
                             const char *visibility)
{
    const char *const choices[] = {injection, bounces_with(injection), stratification, visibility,
                                   NULL};
    const double *plain = plain_light(injection);
    double sum = 0, squares = 0, photons = 0;
    for (int i = 0; i < SEEDS; i++) {
        struct rendering rendering = render_seed(i + 1, choices);
        double drift = light(&rendering.image) / plain[i] - 1;
        sum += drift;
        squares += drift * drift;
        photons += statistics_counter(&rendering.statistics, "photons") /
                   statistics_counter(&rendering.statistics, "photons injected") / SEEDS;
        rendering_release(&rendering);
    }
    double mean = sum / SEEDS, variance = fmax(0, squares / SEEDS - mean * mean);
    struct drift drift = {mean, sqrt(variance / (SEEDS - 1)), photons};
    print_message("%-51s %-31s %5.1f %% left, light %+.2f %%, noise %.2f %%\n", stratification,
                  visibility ? visibility : "", 100 * drift.photons, 100 * drift.mean,
                  100 * drift.standard_error);
    return drift;
}

static void expect_no_drift(const char *injection, const char *stratification,
                            const char *visibility)
{
    struct drift drift = drift_of(injection, stratification, visibility);
    assert_true(drift.photons < 0.7);
    assert_true(drift.standard_error < 0.012);
    assert_true(fabs(drift.mean) < 0.02);
}

/* Splats of the same size: what is left is the bias of merging itself. */
static void test_random_has_no_drift(void **state)
{
    (void)state;
    expect_no_drift(SINGLE, "stratification=grid", FIXED);
    expect_no_drift(SINGLE, "stratification=grid:resolution=256,levels=4", FIXED);
    expect_no_drift(SINGLE, "stratification=grid:resolution=64,normal_angle=180", FIXED);
    expect_no_drift(SINGLE, "stratification=grid:resolution=16,bucket=20", FIXED);
    expect_no_drift(SINGLE, "stratification=cascade", FIXED);
    expect_no_drift(SINGLE, "stratification=octree", FIXED);
    expect_no_drift(SEVERAL, "stratification=grid", FIXED);
}

/* As they come: merged photons make larger splats, which are a little more biased. */
static void test_defaults_have_no_drift(void **state)
{
    (void)state;
    expect_no_drift(SINGLE, "stratification=grid", NULL);
    expect_no_drift(SINGLE, "stratification=grid:resolution=64", NULL);
    expect_no_drift(SINGLE, "stratification=cascade", NULL);
    expect_no_drift(SINGLE, "stratification=octree", NULL);
}

/* Told, not asked for: but that `dominant` is far off shows that a drift would be seen. */
static void test_drift_of_the_others(void **state)
{
    (void)state;
    drift_of(SINGLE, "stratification=grid:resolution=64,representative=nearest_mean", FIXED);
    struct drift dominant =
        drift_of(SINGLE, "stratification=grid:resolution=64,representative=dominant", FIXED);
    assert_true(fabs(dominant.mean) > 0.03);
    drift_of(SINGLE, "stratification=grid:resolution=64",
             "visibility=shadowmap:max_merge_scale=1000");
}

static void expect_same_pictures(const struct image *a, const struct image *b)
{
    static const char *const names[] = {"indirect.R", "indirect.G", "indirect.B", "weight"};
    for (int i = 0; i < 4; i++)
        assert_memory_equal(image_channel(a, names[i]), image_channel(b, names[i]),
                            WIDTH * HEIGHT * sizeof(float));
}

static void test_threads_and_batches_change_nothing(void **state)
{
    (void)state;
    static const char *const stratifications[] = {
        "stratification=grid:threshold=4,levels=3,centre=camera,per_cell=2",
        "stratification=cascade:cell=2,resolution=300", "stratification=octree"};
    char *text = cornell_text(WIDTH, HEIGHT);
    for (int i = 0; i < 3; i++) {
        const char *const choices[] = {"injection=photon:count=20000", "bounces=3",
                                       stratifications[i], NULL};
        struct rendering one = render_text(text, 1, choices);
        struct rendering three = render_text_in_batches(text, 3, 17, choices);
        assert_true(statistics_counter(&one.statistics, "photons merged") > 1000);
        expect_same_pictures(&one.image, &three.image);
        rendering_release(&one);
        rendering_release(&three);
    }
    free(text);
}

static void test_fine_cells_change_nothing(void **state)
{
    (void)state;
    static const char *const fine[] = {
        "stratification=grid:resolution=1000000", "stratification=cascade:cell=1e-3,beyond=keep",
        "stratification=cascade:cell=4e-3,levels=2,resolution=1000000",
        "stratification=octree:capacity=1,depth=20"};
    const char *const none[] = {SINGLE, NULL};
    char *text = cornell_text(WIDTH, HEIGHT);
    struct rendering plain = render_text(text, 2, none);
    for (int i = 0; i < 4; i++) {
        const char *const choices[] = {SINGLE, fine[i], NULL};
        struct rendering merged = render_text(text, 2, choices);
        assert_true(statistics_counter(&merged.statistics, "photons") ==
                    statistics_counter(&merged.statistics, "photons injected"));
        expect_same_pictures(&plain.image, &merged.image);
        rendering_release(&merged);
    }
    rendering_release(&plain);
    free(text);
}

/* All that a pass keeps for 25,000 photons at 256^3 cells, against an array's 576 MB. */
static void test_memory(void **state)
{
    (void)state;
    char *text = cornell_text(WIDTH, HEIGHT);
    const char *const choices[] = {"injection=photon:count=30000",
                                   "stratification=grid:resolution=256", NULL};
    struct rendering rendering = render_text(text, 2, choices);
    double injected = statistics_counter(&rendering.statistics, "photons injected");
    double strata = statistics_bytes(&rendering.statistics, "strata");
    double photons = statistics_bytes(&rendering.statistics, "photons");
    print_message("%.0f photons: strata %.2f MB, photons %.2f MB\n", injected, strata / 1e6,
                  photons / 1e6);
    assert_true(injected > 24000 && injected < 26000);
    assert_true(strata > 40 * injected && photons > 64 * injected);
    assert_true(strata + photons < 5.76e6);
    rendering_release(&rendering);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SLOW_TEST(test_random_has_no_drift),
        cmocka_unit_test(test_defaults_have_no_drift),
        SLOW_TEST(test_drift_of_the_others),
        cmocka_unit_test(test_threads_and_batches_change_nothing),
        cmocka_unit_test(test_fine_cells_change_nothing),
        cmocka_unit_test(test_memory),
    };
    return RUN_TESTS(tests);
}
