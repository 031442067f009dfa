/* test_light_shares.c: how light paths are shared among lights, by what camera paths found. */
#include "importance/light_shares.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define LIGHTS 100

static uint32_t order[LIGHTS];
#define ROUNDING 0.032 /* of a share, to five bits */

static float powers[LIGHTS], shares[LIGHTS];
static struct found_light found[LIGHTS];

/* Lights of power 1 of which nothing was found. */
static int prepare(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < LIGHTS; i++) {
        order[i] = i;
        powers[i] = 1.0f;
        found[i] = (struct found_light){0.0, 0.0};
    }
    return 0;
}

static double share_all(void)
{
    double sum = 0.0;
    light_shares(order, powers, found, LIGHTS, shares);
    for (size_t i = 0; i < LIGHTS; i++)
        sum += (double)shares[i];
    return sum;
}

static void test_by_power_where_nothing_is_found(void **state)
{
    (void)state;
    powers[7] = 11.0f;
    powers[8] = 0.0f;
    assert_true(fabs(share_all() - 1.0) < ROUNDING);
    for (size_t i = 0; i < LIGHTS; i++)
        assert_true(fabs((double)shares[i] * 109.0 - (double)powers[i]) <=
                    ROUNDING * (double)powers[i]);
}

/* All that is seen comes from one light of a hundred. */
static void test_light_that_is_seen(void **state)
{
    (void)state;
    found[42] = (struct found_light){1000.0, 2000.0};
    assert_true(fabs(share_all() - 1.0) < ROUNDING);
    assert_true(shares[42] > 0.5f);
    for (size_t i = 0; i < LIGHTS; i++)
        assert_true(i == 42 || (shares[i] >= 0.0019f && shares[i] < 0.02f));
}

/* Of two lights that were found often, the one with a hundredth of the other's light has a tenth of
 * its share, besides what power gives to both; so has one of the same light and a hundredth of the
 * power. */
static void test_root_of_light_and_power(void **state)
{
    (void)state;
    found[10] = (struct found_light){1.0, 1e6};
    found[80] = (struct found_light){100.0, 1e6};
    share_all();
    assert_true(fabs((double)(shares[10] - 0.002f) / (double)(shares[80] - 0.002f) - 0.1) <
                0.1 * 2 * ROUNDING + 0.01);
    found[10].sum = 100.0;
    powers[10] = 0.01f;
    share_all();
    assert_true(fabs((double)(shares[10] - 2e-5f) / (double)(shares[80] - 0.002f) - 0.1) <
                0.1 * 2 * ROUNDING + 0.01);
}

/* What another processor finds, which rounds differently, gives the same shares. */
static void test_shares_stay_when_little_changes(void **state)
{
    (void)state;
    float before[LIGHTS];
    found[10] = (struct found_light){195.403581, 1557};
    found[80] = (struct found_light){103.901502, 648};
    share_all();
    memcpy(before, shares, sizeof before);
    found[10] = (struct found_light){195.840082, 1558};
    found[80] = (struct found_light){103.871877, 648};
    share_all();
    assert_memory_equal(before, shares, sizeof before);
}

/* Where each light was found about once, chance decides which; shares stay near each other. */
static void test_few_finds_are_smoothed(void **state)
{
    (void)state;
    for (size_t i = 0; i < LIGHTS; i++)
        if (i * 7919 % 13 < 6)
            found[i] = (struct found_light){1.0, 1.0};
    share_all();
    for (size_t i = 0; i < LIGHTS; i++)
        assert_true(shares[i] > 0.4f / LIGHTS && shares[i] < 2.0f / LIGHTS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_by_power_where_nothing_is_found, prepare),
        cmocka_unit_test_setup(test_light_that_is_seen, prepare),
        cmocka_unit_test_setup(test_root_of_light_and_power, prepare),
        cmocka_unit_test_setup(test_shares_stay_when_little_changes, prepare),
        cmocka_unit_test_setup(test_few_finds_are_smoothed, prepare),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
