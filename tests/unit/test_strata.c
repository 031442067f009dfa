/* test_strata.c: which photons grid, cascade and octree merge, on photons made for it. The octree
 * in space is for test_octree.c.
 *
 * Photons have power 1, so what is left tells by `merged` how many became one. Strata are sorted by
 * their least x here, for reading.
 */
#include "support/random.h"
#include "support/stratify.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int by_x(const void *a, const void *b)
{
    float x = ((const ps_photon *)a)->position.x, y = ((const ps_photon *)b)->position.x;
    return (x > y) - (x < y);
}

/* Expects that of photons at these x (y = z = 0.5), as many groups are left, with these sizes. */
static void expect_groups(struct stage *stage, const char *choice, const float *x, size_t n,
                          const char *sizes)
{
    ps_photon photons[64];
    char found[256] = "";
    assert_true(n <= 64);
    for (size_t i = 0; i < n; i++)
        photons[i] = stratify_photon((ps_vec3){x[i], 0.5f, 0.5f}, 1, i);
    size_t left = stratify_photons(stage, choice, photons, n);
    qsort(photons, left, sizeof *photons, by_x);
    for (size_t i = 0; i < left; i++) {
        assert_true(photons[i].power.r == photons[i].merged);
        snprintf(found + strlen(found), sizeof found - strlen(found), "%s%g", i ? " " : "",
                 photons[i].merged);
    }
    if (strcmp(found, sizes) != 0)
        fail_msg("%s left groups of %s, expected %s", choice, found, sizes);
}

#define GROUPS(stage, choice, sizes, ...)                                                          \
    do {                                                                                           \
        const float x[] = {__VA_ARGS__};                                                           \
        expect_groups(stage, choice, x, sizeof x / sizeof x[0], sizes);                            \
    } while (0)

/* --- grid --- */

static void test_cells(void **state)
{
    (void)state;
    struct stage stage = stage_of(16);
    GROUPS(&stage, "grid:cell=1,threshold=1", "2 3 1", -0.1f, 0.1f, 0.2f, 0.9f, -0.9f, 3);
    GROUPS(&stage, "grid:cell=2,threshold=1", "2 3 1", -0.1f, 0.1f, 0.2f, 1.9f, -1.9f, 2);
    assert_true(statistics_counter(&stage.statistics, "strata") == 3);
    assert_true(statistics_counter(&stage.statistics, "photons merged") == 3);
    /* 8 cells over the diameter of 32: 4 a cell. */
    GROUPS(&stage, "grid:resolution=8,threshold=1", "2 2 1", -3, -1, 0.5f, 3.9f, 4.1f);
    /* 3 cells: borders at -16/3 and 16/3. */
    GROUPS(&stage, "grid:resolution=3,threshold=1", "1 4 1", -6, -5, -1, 1, 5, 6);
    stage_release(&stage);
}

static void test_centre(void **state)
{
    (void)state;
    struct stage stage = stage_of(16);
    stage.camera = (ps_vec3){100.25f, 0, 0}; /* far away: the grid goes on */
    GROUPS(&stage, "grid:cell=1,threshold=1,centre=scene", "2 1", 0.1f, 0.5f, 1.1f);
    GROUPS(&stage, "grid:cell=1,threshold=1,centre=camera", "1 2", 0.1f, 0.5f, 1.1f);
    stage_release(&stage);
}

/* Blocks of two, four, ... cells begin at the grid's first cell, at x = -16. */
static void test_threshold(void **state)
{
    (void)state;
    struct stage stage = stage_of(16);
    /* Cells 0, 1 | 2, 3 | 4. */
    GROUPS(&stage, "grid:resolution=32,threshold=2", "4 2 2 1", 0.1f, 0.2f, 0.3f, 1.1f, 2.1f, 2.2f,
           3.1f, 3.2f, 4.1f);
    GROUPS(&stage, "grid:resolution=32,threshold=3", "4 4 1", 0.1f, 0.2f, 0.3f, 1.1f, 2.1f, 2.2f,
           3.1f, 3.2f, 4.1f);
    GROUPS(&stage, "grid:resolution=32,threshold=4", "4 4 1", 0.1f, 0.2f, 0.3f, 1.1f, 2.1f, 2.2f,
           3.1f, 3.2f, 4.1f);
    GROUPS(&stage, "grid:resolution=32,threshold=4,levels=0", "3 1 2 2 1", 0.1f, 0.2f, 0.3f, 1.1f,
           2.1f, 2.2f, 3.1f, 3.2f, 4.1f);
    stage_release(&stage);
}

static void test_levels(void **state)
{
    (void)state;
    struct stage stage = stage_of(16);
    /* One photon a cell. Level by level, blocks grow until each holds 3. */
    GROUPS(&stage, "grid:resolution=32,threshold=3,levels=1", "2 2 2 2", 0.5f, 1.5f, 2.5f, 3.5f,
           4.5f, 5.5f, 6.5f, 7.5f);
    GROUPS(&stage, "grid:resolution=32,threshold=3,levels=2", "4 4", 0.5f, 1.5f, 2.5f, 3.5f, 4.5f,
           5.5f, 6.5f, 7.5f);
    GROUPS(&stage, "grid:resolution=32,threshold=3,levels=9", "4 4", 0.5f, 1.5f, 2.5f, 3.5f, 4.5f,
           5.5f, 6.5f, 7.5f);
    GROUPS(&stage, "grid:resolution=32,threshold=5,levels=9", "8", 0.5f, 1.5f, 2.5f, 3.5f, 4.5f,
           5.5f, 6.5f, 7.5f);
    stage_release(&stage);
}

static void test_bucket_and_per_cell(void **state)
{
    (void)state;
    struct stage stage = stage_of(16);
#define TEN 0.01f, 0.02f, 0.03f, 0.04f, 0.05f, 0.06f, 0.07f, 0.08f, 0.09f, 0.1f
    GROUPS(&stage, "grid:cell=1", "10", TEN);
    GROUPS(&stage, "grid:cell=1,bucket=10", "10", TEN);
    GROUPS(&stage, "grid:cell=1,bucket=9", "5 5", TEN);
    GROUPS(&stage, "grid:cell=1,bucket=3", "3 3 2 2", TEN);
    GROUPS(&stage, "grid:cell=1,bucket=1", "1 1 1 1 1 1 1 1 1 1", TEN);
    GROUPS(&stage, "grid:cell=1,per_cell=4", "3 3 2 2", TEN);
    GROUPS(&stage, "grid:cell=1,per_cell=11", "1 1 1 1 1 1 1 1 1 1", TEN);
    GROUPS(&stage, "grid:cell=1,per_cell=2,bucket=4", "4 3 3", TEN);
    GROUPS(&stage, "grid:cell=1,per_cell=3,bucket=9", "4 3 3", TEN);
    stage_release(&stage);
}

static ps_vec3 tilted(double degrees)
{
    double angle = degrees * (double)PS_PI / 180;
    return (ps_vec3){(float)sin(angle), (float)cos(angle), 0};
}

/* Normals at 0, 50, 180 and 20 degrees in one cell; 50 and 20 are close to each other, but what
 * counts is the first. */
static void test_normals(void **state)
{
    (void)state;
    static const struct {
        const char *choice;
        size_t left;
        float first; /* merged of the first group */
    } cases[] = {
        {"grid:cell=1,normal_angle=180", 1, 4},
        {"grid:cell=1,normal_angle=179", 2, 3},
        {"grid:cell=1", 2, 3},
        {"grid:cell=1,normal_angle=49", 3, 2},
        {"octree:normal_angle=49", 3, 2},
        {"grid:cell=1,normal_angle=19", 4, 1},
    };
    struct stage stage = stage_of(16);
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        ps_photon photons[4];
        static const double angles[4] = {0, 50, 180, 20};
        for (size_t i = 0; i < 4; i++) {
            photons[i] = stratify_photon((ps_vec3){0.5f, 0.5f, 0.5f}, 1, i);
            photons[i].normal = tilted(angles[i]);
        }
        assert_int_equal(stratify_photons(&stage, cases[c].choice, photons, 4), cases[c].left);
        float merged = 0; /* of the group that the photon of normal 0 went to */
        for (size_t i = 0; i < cases[c].left; i++)
            if (photons[i].path != 2 || cases[c].left == 1)
                merged = fmaxf(merged, photons[i].merged);
        assert_true(merged == cases[c].first);
        assert_true(statistics_counter(&stage.statistics, "strata") == (double)cases[c].left);
    }
    stage_release(&stage);
}

static void test_cells_too_small(void **state)
{
    (void)state;
    struct stage stage = stage_of(1e6f);
    assert_true(stratification_refuses(&stage, "grid:cell=1"));
    assert_false(stratification_refuses(&stage, "grid:cell=2"));
    assert_false(stratification_refuses(&stage, "grid:resolution=1000000"));
    assert_true(stratification_refuses(&stage, "cascade:cell=0.1,levels=4"));
    assert_false(stratification_refuses(&stage, "cascade:cell=0.1,levels=4,beyond=keep"));
    assert_false(stratification_refuses(&stage, "cascade:cell=0.1,levels=6"));
    stage_release(&stage);
}

/* --- cascade --- */

#define NESTED "cascade:levels=2,resolution=4,cell=1,growth=2"

/* Around x = 10: cells of 1 up to 2 away, of 2 up to 4 away, then nothing. */
static void test_cascades(void **state)
{
    (void)state;
    struct stage stage = stage_of(32);
    stage.camera = (ps_vec3){10, 0, 0};
    GROUPS(&stage, NESTED, "2 1 2", 10.1f, 10.9f, 11.1f, 12.1f, 13.9f);
    GROUPS(&stage, NESTED, "1 1 2", 6.1f, 8.1f, 9.1f, 9.9f);
    assert_true(statistics_counter(&stage.statistics, "photons beyond") == 0);
    GROUPS(&stage, NESTED ",beyond=keep", "1 1 1 1", 10.1f, 14.1f, 14.2f, -9);
    assert_true(statistics_counter(&stage.statistics, "photons beyond") == 3);
    GROUPS(&stage, NESTED ",beyond=merge", "2 1 2 1", 10.1f, 14.1f, 15.9f, 16.1f, -9, -9.9f);
    GROUPS(&stage, NESTED ",beyond=drop", "1", 10.1f, 14.1f, 14.2f, -9);
    assert_true(statistics_counter(&stage.statistics, "photons beyond") == 3);
    assert_true(statistics_counter(&stage.statistics, "photons merged") == 0);
    stage_release(&stage);
}

/* Cells left to psplat: the outermost grid holds the scene, from wherever one looks. */
static void test_automatic_cascades(void **state)
{
    (void)state;
    enum { N = 500 };
    struct random random = {5};
    ps_photon photons[N];
    for (int place = 0; place < 4; place++) {
        struct stage stage = stage_of(7);
        stage.camera = ps_scale(random_direction(&random), 9 * (float)place);
        for (size_t i = 0; i < N; i++)
            photons[i] = stratify_photon(ps_scale(random_direction(&random), 7), 1, i);
        stratify_photons(&stage, "cascade:levels=3,beyond=drop", photons, N);
        assert_true(statistics_counter(&stage.statistics, "photons beyond") == 0);
        stage_release(&stage);
    }
}

/* --- octree --- */

static void test_octree(void **state)
{
    (void)state;
    struct stage stage = stage_of(16);
    GROUPS(&stage, "octree:capacity=5", "5", -9, 0.5f, 1.5f, 4.5f, 9);
    GROUPS(&stage, "octree:capacity=4", "1 4", -9, 0.5f, 1.5f, 4.5f, 9);
    GROUPS(&stage, "octree:capacity=3", "1 3 1", -9, 0.5f, 1.5f, 4.5f, 9); /* 0 .. 8 .. 16 */
    GROUPS(&stage, "octree:capacity=2", "1 2 1 1", -9, 0.5f, 1.5f, 4.5f, 9);
    GROUPS(&stage, "octree:capacity=2,depth=2", "1 3 1", -9, 0.5f, 1.5f, 4.5f, 9);
    GROUPS(&stage, "octree:capacity=1,depth=0", "5", -9, 0.5f, 1.5f, 4.5f, 9);
    stage_release(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_centre),
        cmocka_unit_test(test_threshold),
        cmocka_unit_test(test_levels),
        cmocka_unit_test(test_bucket_and_per_cell),
        cmocka_unit_test(test_normals),
        cmocka_unit_test(test_cells_too_small),
        cmocka_unit_test(test_cascades),
        cmocka_unit_test(test_automatic_cascades),
        cmocka_unit_test(test_octree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
