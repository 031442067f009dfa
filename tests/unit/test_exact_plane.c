/* test_exact_plane.c: sums of floats are exact, and the same in every order and grouping. */
#include "film/exact_plane.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define SIZE 1000
#define ADDENDS 64

/* Numbers of any sign whose exponents differ by up to `range` powers of 2, `top` at most. */
static float any_number(uint32_t *state, int range, int top)
{
    *state = *state * 1664525u + 1013904223u;
    float mantissa = 1.0f + (float)(*state >> 9) * 0x1p-23f;
    *state = *state * 1664525u + 1013904223u;
    return ldexpf(*state & 64 ? -mantissa : mantissa,
                  top - (int)((*state >> 10) % (uint32_t)range));
}

static float (*any_numbers(int range, int top))[SIZE]
{
    float(*numbers)[SIZE] = malloc(ADDENDS * sizeof *numbers);
    uint32_t state = 1;
    assert_non_null(numbers);
    for (int i = 0; i < ADDENDS; i++)
        for (int k = 0; k < SIZE; k++)
            numbers[i][k] = any_number(&state, range, top);
    return numbers;
}

/* Addends from `first` on, in steps. */
static struct exact_plane sum_of(float (*numbers)[SIZE], int first, int step)
{
    struct exact_plane plane;
    assert_true(exact_plane_create(SIZE, &plane));
    for (int i = first; i < ADDENDS; i += step)
        assert_true(exact_plane_add(&plane, numbers[i]));
    return plane;
}

static void expect_equal(const struct exact_plane *a, const struct exact_plane *b)
{
    assert_memory_equal(a->high, b->high, SIZE * sizeof(double));
    for (size_t i = 0; i < SIZE; i++)
        assert_true((a->low ? a->low[i] : 0.0) == (b->low ? b->low[i] : 0.0));
}

static void expect_same_in_any_order(int range, int top)
{
    float(*numbers)[SIZE] = any_numbers(range, top);
    struct exact_plane forwards = sum_of(numbers, 0, 1), backwards, merged = sum_of(numbers, 2, 3);
    assert_true(exact_plane_create(SIZE, &backwards));
    for (int i = ADDENDS - 1; i >= 0; i--)
        assert_true(exact_plane_add(&backwards, numbers[i]));
    for (int part = 0; part < 2; part++) {
        struct exact_plane other = sum_of(numbers, part, 3);
        assert_true(exact_plane_merge(&merged, &other));
        exact_plane_release(&other);
    }
    expect_equal(&forwards, &backwards);
    expect_equal(&forwards, &merged);
    exact_plane_release(&forwards);
    exact_plane_release(&backwards);
    exact_plane_release(&merged);
    free(numbers);
}

static void test_order_does_not_matter(void **state)
{
    (void)state;
    expect_same_in_any_order(8, 2);
    expect_same_in_any_order(60, 10);
    expect_same_in_any_order(90, 45);
}

/* Against integers, in units of 2^-48. */
static void test_sums_are_exact(void **state)
{
    (void)state;
    float(*numbers)[SIZE] = any_numbers(18, 6);
    struct exact_plane plane = sum_of(numbers, 0, 1);
    for (int k = 0; k < SIZE; k++) {
        int64_t exact = 0;
        for (int i = 0; i < ADDENDS; i++)
            exact += (int64_t)ldexp((double)numbers[i][k], 48);
        int64_t sum = (int64_t)ldexp(plane.high[k], 48);
        if (plane.low)
            sum += (int64_t)ldexp(plane.low[k], 48);
        assert_true(sum == exact);
    }
    exact_plane_release(&plane);
    free(numbers);
}

/* What is smaller than the step is rounded, each addend by itself. */
static void test_small_numbers_are_rounded(void **state)
{
    (void)state;
    struct exact_plane plane;
    const float tiny = 0x1p-50f, half = 0x1.8p-48f;
    assert_true(exact_plane_create(1, &plane));
    for (int i = 0; i < 1000; i++)
        assert_true(exact_plane_add(&plane, &tiny));
    assert_true(plane.high[0] == 0.0);
    assert_true(exact_plane_add(&plane, &half));
    assert_true(plane.high[0] == 0x1p-47);
    exact_plane_release(&plane);
}

/* Low parts take no memory before they are needed. */
static void test_low_parts(void **state)
{
    (void)state;
    struct exact_plane plane;
    float numbers[2] = {0.1f, 7.0f};
    const float large[2] = {0, 0x1p30f};
    assert_true(exact_plane_create(2, &plane));
    for (int i = 0; i < 4; i++)
        assert_true(exact_plane_add(&plane, numbers));
    assert_null(plane.low);
    assert_int_equal(exact_plane_bytes(&plane), 2 * sizeof(double));
    numbers[1] = 0x1.fffffep-20f;
    assert_true(exact_plane_add(&plane, numbers));
    assert_true(exact_plane_add(&plane, large));
    assert_non_null(plane.low);
    assert_int_equal(exact_plane_bytes(&plane), 4 * sizeof(double));
    exact_plane_release(&plane);
}

static void test_expansion(void **state)
{
    (void)state;
    float(*numbers)[SIZE] = any_numbers(90, 45), terms[SIZE], rounded[SIZE];
    struct exact_plane plane = sum_of(numbers, 0, 1), again;
    assert_true(exact_plane_create(SIZE, &again));
    exact_plane_round(&plane, rounded);
    int count = 0;
    while (exact_plane_term(&plane, count, terms)) {
        if (count == 0)
            assert_memory_equal(terms, rounded, sizeof terms);
        assert_true(exact_plane_add(&again, terms));
        assert_true(++count < 8);
    }
    assert_true(count > 2);
    expect_equal(&plane, &again);
    for (int k = 0; k < SIZE; k++)
        assert_true(terms[k] == 0);
    exact_plane_release(&plane);
    exact_plane_release(&again);
    free(numbers);
}

static void test_infinity_stays(void **state)
{
    (void)state;
    struct exact_plane plane;
    const float infinite = INFINITY, one = 1;
    float sum;
    assert_true(exact_plane_create(1, &plane));
    assert_true(exact_plane_add(&plane, &one));
    assert_true(exact_plane_add(&plane, &infinite));
    assert_true(exact_plane_add(&plane, &one));
    exact_plane_round(&plane, &sum);
    assert_true(isinf(sum));
    assert_true(exact_plane_term(&plane, 0, &sum) && isinf(sum));
    assert_false(exact_plane_term(&plane, 1, &sum));
    exact_plane_release(&plane);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order_does_not_matter),
        cmocka_unit_test(test_sums_are_exact),
        cmocka_unit_test(test_small_numbers_are_rounded),
        cmocka_unit_test(test_low_parts),
        cmocka_unit_test(test_expansion),
        cmocka_unit_test(test_infinity_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
