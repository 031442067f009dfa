/* test_caustics.c: the radius of caustics by the density of the first landings. */
#include "placement/caustics.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SIDE 32
#define PI 3.14159265358979323846

/* A grid, so many times as dense along both axes where x < 0. */
static size_t lay_out(ps_vec3 landings[CAUSTIC_LANDINGS], int denser)
{
    size_t count = 0;
    for (int i = 0; i < SIDE * SIDE / 4; i++) {
        float x = (float)(i % (SIDE / 2)) + 0.5f, z = (float)(i / (SIDE / 2)) + 0.5f;
        landings[count++] = (ps_vec3){x, 0, z};
        landings[count++] = (ps_vec3){-x / (float)denser, 0, z / (float)denser};
    }
    return count;
}

/* 200 photons share the disc, if there are ten for each landing, but for what a grid differs from
 * chance. */
static void test_radius_goes_by_density(void **state)
{
    (void)state;
    static ps_vec3 landings[CAUSTIC_LANDINGS];
    struct caustics caustics = {landings, lay_out(landings, 4), caustics_scale(10, 0)};
    double sparse = caustics_radius(&caustics, (ps_vec3){8.2f, 0, 8.1f});
    double dense = caustics_radius(&caustics, (ps_vec3){-2.05f, 0, 2.025f});
    double photons = PI * sparse * sparse * 10;
    assert_true(photons > 130 && photons < 350);
    assert_true(fabs(sparse / dense - 4) < 0.05);
}

static void test_radius_shrinks_with_photons_and_passes(void **state)
{
    (void)state;
    assert_true(fabs((double)(caustics_scale(4, 0) / caustics_scale(16, 0)) - 2) < 1e-5);
    assert_true(fabs((double)(caustics_scale(4, 0) / caustics_scale(4, 63)) - 2) < 1e-5);
}

static void test_few_landings_tell_nothing(void **state)
{
    (void)state;
    static const ps_vec3 landings[5] = {{0, 0, 0}};
    struct caustics caustics = {landings, 5, caustics_scale(1, 0)};
    assert_true(isinf(caustics_radius(&caustics, (ps_vec3){0, 0, 0})));
    caustics.count = 0;
    assert_true(isinf(caustics_radius(&caustics, (ps_vec3){0, 0, 0})));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_radius_goes_by_density),
        cmocka_unit_test(test_radius_shrinks_with_photons_and_passes),
        cmocka_unit_test(test_few_landings_tell_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
