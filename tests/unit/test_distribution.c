/* test_distribution.c: choices by weight against their probabilities, in one dimension and two. */
#include "scene/distribution.h"

#include "support/chi_squared.h"
#include "support/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#define SAMPLES 200000
#define PARTS 4 /* of a cell, to see whether places within it are even */
#define UNLIKELY 1e-4
#define LAST (1.0f - 0x1p-24f)

static const float weights[] = {3, 1, 0, 4, 1, 5, 9, 2, 6, 0, 5, 3, 5, 8, 9, 7, 0};
#define COUNT (sizeof weights / sizeof weights[0])

static struct distribution distribution_of(const float *values, size_t count)
{
    struct distribution distribution;
    struct error error;
    assert_int_equal(distribution_create(values, count, &distribution, &error), PS_OK);
    return distribution;
}

/* Chi-squared of the entries chosen, and of the places within, against the weights. `bend` makes
 * the numbers uneven, which must show. */
static double fit(const struct distribution *distribution, const float *shares, size_t count,
                  float bend)
{
    double observed[COUNT * PARTS] = {0}, expected[COUNT * PARTS], total = 0;
    struct random random = {3};
    for (int i = 0; i < SAMPLES; i++) {
        float u = random_unit(&random), rest;
        size_t entry = distribution_choose(distribution, u + bend * u * (1 - u), &rest);
        assert_true(entry < count && rest >= 0 && rest < 1);
        observed[entry * PARTS + (size_t)(rest * PARTS)]++;
    }
    for (size_t i = 0; i < count; i++)
        total += shares[i];
    size_t cells = 0;
    for (size_t i = 0; i < count * PARTS; i++) {
        if (shares[i / PARTS] == 0) {
            assert_true(observed[i] == 0);
            continue;
        }
        observed[cells] = observed[i];
        expected[cells++] = SAMPLES * shares[i / PARTS] / total / PARTS;
    }
    return chi_squared_probability(observed, expected, cells);
}

static void test_choices_follow_the_weights(void **state)
{
    (void)state;
    struct distribution distribution = distribution_of(weights, COUNT);
    assert_true(distribution.total == 68);
    assert_true(fit(&distribution, weights, COUNT, 0) > UNLIKELY);
    for (size_t i = 0; i < COUNT; i++)
        assert_true(fabsf(distribution_probability(&distribution, i) - weights[i] / 68) < 1e-6f);
    /* The test would see other numbers, and other weights. */
    float others[COUNT];
    for (size_t i = 0; i < COUNT; i++)
        others[i] = weights[i] * (i == 6 ? 1.1f : 1.0f);
    assert_true(fit(&distribution, weights, COUNT, 0.05f) < 1e-6);
    assert_true(fit(&distribution, others, COUNT, 0) < 1e-6);
    distribution_release(&distribution);
}

/* What is said of an entry is exactly how many of all 2^24 numbers choose it. */
static void test_probabilities_are_exact(void **state)
{
    (void)state;
    static const float values[] = {1, 1e-3f, 7, 0.1f, 2};
    enum { ENTRIES = 5, STEPS = 1 << 24 };
    struct distribution distribution = distribution_of(values, ENTRIES);
    double chosen[ENTRIES] = {0};
    for (int i = 0; i < STEPS; i++) {
        float rest;
        chosen[distribution_choose(&distribution, (float)i * 0x1p-24f, &rest)]++;
    }
    for (size_t i = 0; i < ENTRIES; i++)
        assert_true(fabs(chosen[i] / STEPS - distribution_probability(&distribution, i)) <=
                    1.0 / STEPS);
    distribution_release(&distribution);
}

static void expect_only(const struct distribution *distribution, size_t entry)
{
    static const float ends[] = {0, 0x1p-24f, 0.5f, LAST, 1};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        float rest;
        assert_int_equal(distribution_choose(distribution, ends[i], &rest), entry);
        assert_true(rest >= 0 && rest < 1);
    }
    assert_true(distribution_probability(distribution, entry) == 1);
}

static void test_entries_of_weight_0_are_never_chosen(void **state)
{
    (void)state;
    static const float first[] = {2, 0, 0}, middle[] = {0, 0, 2, 0}, last[] = {0, 0, 2};
    struct distribution distribution = distribution_of(first, 3);
    expect_only(&distribution, 0);
    distribution_release(&distribution);
    distribution = distribution_of(middle, 4);
    expect_only(&distribution, 2);
    distribution_release(&distribution);
    distribution = distribution_of(last, 3);
    expect_only(&distribution, 2);
    distribution_release(&distribution);
}

static void test_all_dark_is_even(void **state)
{
    (void)state;
    static const float nothing[4] = {0, 0, 0, 0}, even[4] = {1, 1, 1, 1};
    struct distribution distribution = distribution_of(nothing, 4);
    assert_true(distribution.total == 0);
    assert_true(fit(&distribution, even, 4, 0) > UNLIKELY);
    distribution_release(&distribution);
}

/* A bright entry among a million faint ones, and sizes of all orders. */
static void expect_first_above(const struct distribution *distribution, float u)
{
    float rest;
    size_t entry = distribution_choose(distribution, u, &rest);
    u = u < LAST ? u : LAST;
    assert_true(distribution->cumulative[entry] > u);
    assert_true(entry == 0 || !(distribution->cumulative[entry - 1] > u));
}

/* Wherever the guide begins: of few entries and of many, at the ends of its cells and beside
 * them. */
static void test_the_entry_is_the_first_above(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 2, 3, 12, 1000, 65536, 300000};
    struct random random = {5};
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        float *values = malloc(counts[k] * sizeof *values);
        assert_non_null(values);
        for (size_t i = 0; i < counts[k]; i++) {
            float u = random_unit(&random);
            values[i] = u < 0.2f ? 0 : powf(u, 20);
        }
        struct distribution distribution = distribution_of(values, counts[k]);
        for (size_t i = 0; i <= distribution.guides; i++) {
            float u = (float)i / (float)distribution.guides;
            expect_first_above(&distribution, u);
            expect_first_above(&distribution, nextafterf(u, 0));
            expect_first_above(&distribution, fminf(nextafterf(u, 2), 1));
        }
        for (int i = 0; i < SAMPLES; i++)
            expect_first_above(&distribution, random_unit(&random));
        distribution_release(&distribution);
        free(values);
    }
}

static void test_extremes(void **state)
{
    (void)state;
    enum { MANY = 1000000 };
    float *values = malloc(MANY * sizeof *values);
    assert_non_null(values);
    for (size_t i = 0; i < MANY; i++)
        values[i] = i == 777777 ? 1e30f : 1e-30f * (float)(i % 7);
    struct distribution distribution = distribution_of(values, MANY);
    expect_only(&distribution, 777777);
    distribution_release(&distribution);
    for (size_t i = 0; i < MANY; i++)
        values[i] = 1;
    distribution = distribution_of(values, MANY);
    for (size_t i = 0; i < MANY; i += 1013) {
        float rest;
        size_t entry = distribution_choose(&distribution, ((float)i + 0.5f) / MANY, &rest);
        assert_true(entry + 1 >= i && entry <= i + 1);
    }
    distribution_release(&distribution);
    free(values);
}

/* --- two dimensions --- */

enum { WIDTH = 5, HEIGHT = 4 };
static const float grid[HEIGHT * WIDTH] = {
    1, 2, 0, 3, 4, /**/ 0, 0, 0, 0, 0, /**/ 9, 1, 0, 0, 5, /**/ 0, 6, 2, 7, 0,
};

static double fit_2d(const struct distribution_2d *distribution, const float *shares)
{
    enum { CELLS = WIDTH * HEIGHT * PARTS };
    double observed[CELLS] = {0}, expected[CELLS], total = 0;
    struct random random = {5};
    for (int i = 0; i < SAMPLES; i++) {
        float u = random_unit(&random), v = random_unit(&random);
        struct distribution_cell cell = distribution_2d_choose(distribution, u, v);
        size_t index = cell.row * WIDTH + cell.column;
        assert_true(cell.column < WIDTH && cell.row < HEIGHT);
        assert_true(cell.probability ==
                    distribution_2d_probability(distribution, cell.column, cell.row));
        observed[index * PARTS + 2 * (cell.rest_column >= 0.5f) + (cell.rest_row >= 0.5f)]++;
    }
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        total += shares[i];
    size_t cells = 0;
    for (size_t i = 0; i < CELLS; i++) {
        if (shares[i / PARTS] == 0) {
            assert_true(observed[i] == 0);
            continue;
        }
        observed[cells] = observed[i];
        expected[cells++] = SAMPLES * shares[i / PARTS] / total / PARTS;
    }
    return chi_squared_probability(observed, expected, cells);
}

static void test_cells_follow_the_weights(void **state)
{
    (void)state;
    struct distribution_2d distribution;
    struct error error;
    assert_int_equal(distribution_2d_create(grid, WIDTH, HEIGHT, &distribution, &error), PS_OK);
    assert_true(distribution.rows.total == 40);
    assert_true(fit_2d(&distribution, grid) > UNLIKELY);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(fabsf(distribution_2d_probability(&distribution, i % WIDTH, i / WIDTH) -
                          grid[i] / 40) < 1e-6f);
    float others[WIDTH * HEIGHT];
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        others[i] = grid[i] * (i == 10 ? 1.1f : 1.0f);
    assert_true(fit_2d(&distribution, others) < 1e-6);
    distribution_2d_release(&distribution);
}

static void test_dark_grid_is_even(void **state)
{
    (void)state;
    float nothing[WIDTH * HEIGHT] = {0}, even[WIDTH * HEIGHT];
    struct distribution_2d distribution;
    struct error error;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        even[i] = 1;
    assert_int_equal(distribution_2d_create(nothing, WIDTH, HEIGHT, &distribution, &error), PS_OK);
    assert_true(fit_2d(&distribution, even) > UNLIKELY);
    distribution_2d_release(&distribution);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_choices_follow_the_weights),
        cmocka_unit_test(test_probabilities_are_exact),
        cmocka_unit_test(test_entries_of_weight_0_are_never_chosen),
        cmocka_unit_test(test_all_dark_is_even),
        cmocka_unit_test(test_the_entry_is_the_first_above),
        cmocka_unit_test(test_extremes),
        cmocka_unit_test(test_cells_follow_the_weights),
        cmocka_unit_test(test_dark_grid_is_even),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
