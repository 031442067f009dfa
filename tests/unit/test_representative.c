/* test_representative.c: which source of a stratum stays. */
#include "support/stratify.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#define RADIUS 10.0f

static ps_source source_at(float x, float power, uint64_t path)
{
    return stratify_source((ps_vec3){x, 0.5f, 0.5f}, power, path);
}

static void test_nearest_mean(void **state)
{
    (void)state;
    struct stage stage = stage_of(RADIUS);
    /* The mean weighs: 0.1, 0.2 and 0.9 with powers 1, 1, 4 have theirs at 0.65. */
    ps_source even[] = {source_at(0.1f, 1, 0), source_at(0.5f, 1, 1), source_at(0.8f, 1, 2)};
    ps_source uneven[] = {source_at(0.1f, 1, 0), source_at(0.2f, 1, 1), source_at(0.9f, 4, 2)};
    assert_int_equal(stratify(&stage, "grid:cell=1,representative=nearest_mean", even, 3), 1);
    assert_int_equal(even[0].path, 1);
    assert_true(even[0].power.r == 3 && even[0].merged == 3);
    assert_int_equal(stratify(&stage, "octree:representative=nearest_mean", uneven, 3), 1);
    assert_int_equal(uneven[0].path, 2);
    stage_release(&stage);
}

static void test_dominant(void **state)
{
    (void)state;
    struct stage stage = stage_of(RADIUS);
    ps_source sources[] = {source_at(0.1f, 1, 0), source_at(0.5f, 1, 1), source_at(0.8f, 5, 2)};
    sources[0].direction = (ps_vec3){1, 0, 0};
    sources[1].direction = (ps_vec3){0, 1, 0};
    sources[2].direction = (ps_vec3){0.6f, 0, 0.8f};
    assert_int_equal(stratify(&stage, "grid:cell=1,representative=dominant", sources, 3), 1);
    assert_int_equal(sources[0].path, 2);
    assert_true(sources[0].power.r == 7);
    stage_release(&stage);
}

/* Of the sources 3, 1, 0 and 6 of each cell, how often the i-th stays; in one pass, and one seed. */
static void test_random_goes_by_power(void **state)
{
    (void)state;
    enum { CELLS = 4000 };
    static const float powers[4] = {3, 1, 0, 6};
    struct stage stage = stage_of(1.5f * CELLS);
    ps_source *sources = malloc(4 * CELLS * sizeof *sources);
    assert_non_null(sources);
    int kept[4] = {0};
    for (size_t i = 0; i < 4 * CELLS; i++) {
        size_t cell = i / 4, member = i % 4;
        sources[i] = source_at((float)cell + 0.2f * (float)(member + 1), powers[member], i);
    }
    assert_int_equal(stratify(&stage, "grid:cell=1,threshold=1", sources, 4 * CELLS), CELLS);
    for (size_t i = 0; i < CELLS; i++) {
        assert_true(sources[i].power.g == 10 && sources[i].merged == 4);
        kept[sources[i].path % 4]++;
    }
    print_message("kept by power 3, 1, 0, 6: %d, %d, %d, %d\n", kept[0], kept[1], kept[2], kept[3]);
    assert_int_equal(kept[2], 0);
    assert_true(abs(kept[0] - 3 * CELLS / 10) < CELLS / 40);
    assert_true(abs(kept[1] - CELLS / 10) < CELLS / 40);
    free(sources);
    stage_release(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nearest_mean),
        cmocka_unit_test(test_dominant),
        cmocka_unit_test(test_random_goes_by_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
