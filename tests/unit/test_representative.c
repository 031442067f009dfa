/* test_representative.c: which photon of a stratum stays. */
#include "support/stratify.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#define RADIUS 10.0f

static ps_photon photon_at(float x, float power, uint64_t path)
{
    return stratify_photon((ps_vec3){x, 0.5f, 0.5f}, power, path);
}

static void test_nearest_mean(void **state)
{
    (void)state;
    struct stage stage = stage_of(RADIUS);
    /* The mean weighs: 0.1, 0.2 and 0.9 with powers 1, 1, 4 have theirs at 0.65. */
    ps_photon even[] = {photon_at(0.1f, 1, 0), photon_at(0.5f, 1, 1), photon_at(0.8f, 1, 2)};
    ps_photon uneven[] = {photon_at(0.1f, 1, 0), photon_at(0.2f, 1, 1), photon_at(0.9f, 4, 2)};
    assert_int_equal(stratify_photons(&stage, "grid:cell=1,representative=nearest_mean", even, 3),
                     1);
    assert_int_equal(even[0].path, 1);
    assert_true(even[0].power.r == 3 && even[0].merged == 3);
    assert_int_equal(stratify_photons(&stage, "octree:representative=nearest_mean", uneven, 3), 1);
    assert_int_equal(uneven[0].path, 2);
    stage_release(&stage);
}

static void test_dominant(void **state)
{
    (void)state;
    struct stage stage = stage_of(RADIUS);
    ps_photon photons[] = {photon_at(0.1f, 1, 0), photon_at(0.5f, 1, 1), photon_at(0.8f, 5, 2)};
    photons[0].direction = (ps_vec3){1, 0, 0};
    photons[1].direction = (ps_vec3){0, 1, 0};
    photons[2].direction = (ps_vec3){0.6f, 0, 0.8f};
    assert_int_equal(stratify_photons(&stage, "grid:cell=1,representative=dominant", photons, 3),
                     1);
    assert_int_equal(photons[0].path, 2);
    assert_true(photons[0].power.r == 7);
    stage_release(&stage);
}

/* Of the photons 3, 1, 0 and 6 of each cell, how often the i-th stays; in one pass, and one
 * seed. */
static void test_random_goes_by_power(void **state)
{
    (void)state;
    enum { CELLS = 4000 };
    static const float powers[4] = {3, 1, 0, 6};
    struct stage stage = stage_of(1.5f * CELLS);
    ps_photon *photons = malloc(4 * CELLS * sizeof *photons);
    assert_non_null(photons);
    int kept[4] = {0};
    for (size_t i = 0; i < 4 * CELLS; i++) {
        size_t cell = i / 4, member = i % 4;
        photons[i] = photon_at((float)cell + 0.2f * (float)(member + 1), powers[member], i);
    }
    assert_int_equal(stratify_photons(&stage, "grid:cell=1,threshold=1", photons, 4 * CELLS),
                     CELLS);
    for (size_t i = 0; i < CELLS; i++) {
        assert_true(photons[i].power.g == 10 && photons[i].merged == 4);
        kept[photons[i].path % 4]++;
    }
    print_message("kept by power 3, 1, 0, 6: %d, %d, %d, %d\n", kept[0], kept[1], kept[2], kept[3]);
    assert_int_equal(kept[2], 0);
    assert_true(abs(kept[0] - 3 * CELLS / 10) < CELLS / 40);
    assert_true(abs(kept[1] - CELLS / 10) < CELLS / 40);
    free(photons);
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
