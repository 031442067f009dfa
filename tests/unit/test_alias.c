/* test_alias.c: an alias table holds each entry's chance, whatever the weights. */
#include "host/alias.h"
#include "support/random.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#define MOST 5000

static ps_alias table[MOST];
static uint32_t order[MOST];

/* What the table gives to each entry, in cells, added up over the table. */
static void expect_chances(const float *weights, uint32_t n)
{
    static double chances[MOST];
    double total = alias_service.build(weights, n, table, order), sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        sum += (double)weights[i];
        chances[i] = 0;
    }
    assert_true(fabs(total / sum - 1) < 1e-12);
    for (uint32_t i = 0; i < n; i++) {
        assert_true(table[i].own >= 0 && table[i].own <= 1 && table[i].other < n);
        chances[i] += (double)table[i].own;
        chances[table[i].other] += 1 - (double)table[i].own;
    }
    for (uint32_t i = 0; i < n; i++) {
        double expected = (double)weights[i] / sum * n;
        if (!(weights[i] > 0))
            assert_true(chances[i] == 0);
        assert_true(fabs(chances[i] - expected) < 1e-6 * (expected + 1) + 2e-8 * n);
    }
}

static void test_chances(void **state)
{
    (void)state;
    static float weights[MOST];
    struct random random = {7};
    for (uint32_t n = 1; n <= MOST; n = 3 * n + 1)
        for (int kind = 0; kind < 5; kind++) {
            for (uint32_t i = 0; i < n; i++) {
                float u = random_unit(&random);
                const float kinds[] = {u, 1.0f, powf(u, 40), u < 0.5f ? 0.0f : u, 1e-3f * u};
                weights[i] = kinds[kind];
            }
            weights[n / 2] = kind == 4 ? 1e4f : 1.0f;
            expect_chances(weights, n);
        }
}

static void test_choice(void **state)
{
    (void)state;
    static const float weights[4] = {3, 0, 1, 4};
    int counts[4] = {0};
    assert_true(alias_service.build(weights, 4, table, order) == 8);
    for (int i = 0; i < 400; i++)
        for (int k = 0; k < 400; k++)
            counts[alias_service.choose(table, 4, (i + 0.5) / 100, ((float)k + 0.5f) / 400)]++;
    assert_int_equal(counts[0], 60000);
    assert_int_equal(counts[1], 0);
    assert_int_equal(counts[2], 20000);
    assert_int_equal(counts[3], 80000);
    assert_true(alias_service.choose(table, 4, 4.0, 0.999f) < 4);
}

static void test_nothing_to_choose(void **state)
{
    (void)state;
    static const float zeros[3] = {0, 0, 0};
    assert_true(alias_service.build(zeros, 3, table, order) == 0);
    assert_true(alias_service.build(zeros, 0, table, order) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chances),
        cmocka_unit_test(test_choice),
        cmocka_unit_test(test_nothing_to_choose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
