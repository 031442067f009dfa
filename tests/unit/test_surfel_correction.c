/* test_surfel_correction.c: the light of surfels by splats, corrected by paths. */
#include "../../plugins/estimator/gather/surfel_correction.h"

#include "support/one_strategy.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define COUNT (32 * SURFELS_OF_RATIO - 10)

static ps_rgb splatted[COUNT], traced[COUNT], half[COUNT];

/* Noise of paths, the same each time: many find nothing, and some much. */
static float found(size_t i)
{
    uint32_t x = ((uint32_t)i ^ ((uint32_t)i >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return (x >> 16) % 4 == 0 ? 4.0f : 0.0f;
}

/* Paths find 1 on average, and 2 in the last channel; splats have that much. */
static void set(float red, float green, float blue)
{
    for (size_t i = 0; i < COUNT; i++) {
        float one = found(2 * i), other = found(2 * i + 1), mean = 0.5f * (one + other);
        splatted[i] = (ps_rgb){red, green, blue};
        traced[i] = (ps_rgb){mean, mean, 2.0f * mean};
        half[i] = (ps_rgb){one, one, 2.0f * one};
    }
}

static void correct(void)
{
    struct bare_host bare;
    bare_host_create(&bare, 1);
    struct surfels surfels = {.host = &bare.host, .count = COUNT, .irradiance = splatted};
    assert_int_equal(surfels_correct(&surfels, traced, half), PS_OK);
    assert_int_equal(bare.live_allocations, 0);
    bare_host_release(&bare);
}

static ps_rgb sum(const ps_rgb *light, size_t first, size_t n)
{
    ps_rgb total = {0, 0, 0};
    for (size_t i = first; i < first + n; i++)
        total = ps_rgb_add(total, light[i]);
    return total;
}

/* Each group has the light that its paths found, whether splats had too much of it, too little or
 * none. */
static void test_no_light_is_lost(void **state)
{
    (void)state;
    set(0.5f, 3.0f, 0.0f);
    correct();
    for (size_t first = 0; first < COUNT; first += SURFELS_OF_RATIO) {
        size_t n = COUNT - first < SURFELS_OF_RATIO ? COUNT - first : SURFELS_OF_RATIO;
        ps_rgb is = sum(splatted, first, n), wanted = sum(traced, first, n);
        assert_float_equal(is.r, wanted.r, 1e-3);
        assert_float_equal(is.g, wanted.g, 1e-3);
        assert_float_equal(is.b, wanted.b, 2e-3);
    }
}

static double variance(const ps_rgb *light)
{
    double squares = 0.0, mean = (double)sum(light, 0, COUNT).r / COUNT;
    for (size_t i = 0; i < COUNT; i++)
        squares += ((double)light[i].r - mean) * ((double)light[i].r - mean);
    return squares / COUNT;
}

/* Smooth splats win over the noise of paths; where splats differ by more than that, paths do. */
static void test_who_is_trusted(void **state)
{
    (void)state;
    set(1.0f, 1.0f, 1.0f);
    correct();
    assert_true(variance(splatted) < 0.1 * variance(traced));
    set(1.0f, 1.0f, 1.0f);
    for (size_t i = 0; i < COUNT; i++) {
        splatted[i].r = i % 2 ? 50.0f : 0.1f;
        traced[i].r = half[i].r = i % 2 ? 1.0f : 2.0f;
    }
    correct();
    for (size_t i = 0; i < COUNT; i++)
        assert_float_equal(splatted[i].r, traced[i].r, 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_light_is_lost),
        cmocka_unit_test(test_who_is_trusted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
