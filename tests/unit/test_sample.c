/* test_sample.c: random numbers: range, purity, independence, stratification, convergence. */
#include "base/sample.h"

#include "support/chi_squared.h"
#include "support/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const uint32_t keys[] = {0, 1, 0x80000000u, 0xffffffffu, 0x12345678u, 77, 0xdeadbeefu};
#define KEYS (sizeof keys / sizeof keys[0])

static void test_range(void **state)
{
    (void)state;
    static const uint64_t starts[] = {0, UINT32_MAX - 5000ull, UINT64_MAX - 10000};
    double largest = 0, smallest = 1;
    for (size_t k = 0; k < KEYS; k++)
        for (size_t s = 0; s < 3; s++)
            for (uint64_t i = 0; i < 10000; i++) {
                float point[4];
                sample_point(keys[k], starts[s] + i, point);
                for (int d = 0; d < 4; d++) {
                    assert_true(point[d] >= 0.0f && point[d] < 1.0f);
                    largest = fmax(largest, point[d]);
                    smallest = fmin(smallest, point[d]);
                }
            }
    assert_true(smallest < 0.001 && largest > 0.999);
}

static void test_pure_function(void **state)
{
    (void)state;
    float first[64][4], again[4];
    for (uint64_t i = 0; i < 64; i++)
        sample_point(sample_key(3, 1, 2), i, first[i]);
    for (uint64_t i = 64; i-- > 0;) {
        sample_point(sample_key(3, 1, 2), i, again);
        assert_memory_equal(again, first[i], sizeof again);
    }
    assert_int_equal(sample_key(3, 1, 2), sample_key(3, 1, 2));
    assert_int_equal(sample_hash(42), sample_hash(42));
}

static void test_points_are_those_of_their_indices(void **state)
{
    static const uint64_t indices[] = {5, 6, UINT64_C(1) << 32, UINT64_MAX, 7, 0, UINT64_MAX - 1};
    enum { N = sizeof indices / sizeof indices[0] };
    float points[N + 1][4], point[4];
    (void)state;
    for (size_t first = 0; first < N; first++) {
        points[N - first][0] = -1;
        sample_points(77, indices + first, N - first, points);
        for (size_t i = first; i < N; i++) {
            sample_point(77, indices[i], point);
            assert_memory_equal(points[i - first], point, sizeof point);
        }
        assert_true(points[N - first][0] == -1);
    }
    sample_points(77, indices, 0, points);
}

/* Pictures of one seed are the same for ever: these are the numbers of the first version. */
static void test_same_numbers_as_ever(void **state)
{
    static const struct {
        uint32_t key;
        uint64_t index;
        float point[4];
    } known[] = {
        {0, UINT64_C(0), {0x1.91d6ap-3f, 0x1.38c1fcp-2f, 0x1.5d27a8p-3f, 0x1.62fb28p-2f}},
        {0, UINT64_C(0x1), {0x1.ed0bc6p-1f, 0x1.a00a02p-1f, 0x1.c5d5ccp-1f, 0x1.2598fp-1f}},
        {12345u, UINT64_C(0x1), {0x1.37096cp-1f, 0x1.5921e6p-1f, 0x1.b7fb98p-3f, 0x1.ffb53ep-1f}},
        {12345u,
         UINT64_C(0x12345678),
         {0x1.41c8fcp-2f, 0x1.74dc28p-2f, 0x1.300538p-1f, 0x1.a8271p-1f}},
        {12345u,
         UINT64_C(0xffffffff),
         {0x1.076a2cp-1f, 0x1.d882b8p-2f, 0x1.9936ccp-1f, 0x1.c1e92p-5f}},
        {12345u,
         UINT64_C(0x123456789abcdef),
         {0x1.5a5adap-1f, 0x1.f0d31cp-1f, 0x1.2f7e6cp-2f, 0x1.4709dp-2f}},
        {3735928559u,
         UINT64_C(0x12345678),
         {0x1.a8c184p-2f, 0x1.192742p-1f, 0x1.43c9e2p-1f, 0x1.d4f238p-2f}},
        {3735928559u,
         UINT64_C(0x123456789abcdef),
         {0x1.ac10ep-2f, 0x1.48c456p-1f, 0x1.49a5a4p-1f, 0x1.dc5978p-1f}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        float point[4];
        sample_point(known[i].key, known[i].index, point);
        assert_memory_equal(point, known[i].point, sizeof point);
    }
}

/* Correlation of dimension a of one key's points with dimension b of another's. */
static double correlation(uint32_t key_a, int a, uint32_t key_b, int b)
{
    enum { N = 4096 };
    double sum_x = 0, sum_y = 0, sum_xx = 0, sum_yy = 0, sum_xy = 0;
    for (uint64_t i = 0; i < N; i++) {
        float p[4], q[4];
        sample_point(key_a, i, p);
        sample_point(key_b, i, q);
        double x = p[a], y = q[b];
        sum_x += x;
        sum_y += y;
        sum_xx += x * x;
        sum_yy += y * y;
        sum_xy += x * y;
    }
    double covariance = sum_xy / N - sum_x / N * (sum_y / N);
    double variance_x = sum_xx / N - sum_x / N * (sum_x / N);
    double variance_y = sum_yy / N - sum_y / N * (sum_y / N);
    return covariance / sqrt(variance_x * variance_y);
}

/* 5 standard deviations for 4096 pairs: 1.25 / 64 each, as measured over many keys; more than for
 * independent numbers since in a net half of the points share the other half's leading bits. */
#define MOST_CORRELATION (6.25 / 64.0)

static void expect_independent(uint32_t key_a, uint32_t key_b)
{
    assert_true(key_a != key_b);
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
            assert_true(fabs(correlation(key_a, a, key_b, b)) < MOST_CORRELATION);
}

static void test_seeds_streams_and_sets_are_independent(void **state)
{
    (void)state;
    uint32_t key = sample_key(0, 0, 0);
    expect_independent(key, sample_key(1, 0, 0));
    expect_independent(key, sample_key(UINT64_C(1) << 32, 0, 0));
    expect_independent(key, sample_key(UINT64_C(1) << 63, 0, 0));
    expect_independent(key, sample_key(0, 1, 0));
    expect_independent(key, sample_key(0, 0, 1));
    /* No two purposes may meet by exchanging their numbers. */
    expect_independent(sample_key(0, 1, 2), sample_key(0, 2, 1));
    expect_independent(sample_key(1, 2, 0), sample_key(2, 1, 0));
    expect_independent(sample_key(1, 0, 2), sample_key(2, 0, 1));
}

static void test_dimensions_are_independent(void **state)
{
    (void)state;
    for (size_t k = 0; k < KEYS; k++)
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < 4; b++)
                if (a == b)
                    assert_true(correlation(keys[k], a, keys[k], b) > 0.999);
                else
                    assert_true(fabs(correlation(keys[k], a, keys[k], b)) < MOST_CORRELATION);
}

/* How many of 256 points have dimensions a and b in the same of 256 intervals. */
static uint32_t count_on_diagonal(uint32_t key, int a, int b)
{
    uint32_t count = 0;
    for (uint64_t i = 0; i < 256; i++) {
        float point[4];
        sample_point(key, i, point);
        count += (uint32_t)(point[a] * 256) == (uint32_t)(point[b] * 256);
    }
    return count;
}

/* Dimensions have scrambles of their own. With one for all, points whose Sobol numbers agree agree
 * ever after, and their count is 0 or a power of two that is no 1. */
static void test_dimensions_are_scrambled_apart(void **state)
{
    (void)state;
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < a; b++) {
            uint32_t odd = 0;
            for (uint32_t seed = 0; seed < 200; seed++)
                odd += count_on_diagonal(sample_key(seed, 0, 0), a, b) % 2;
            assert_in_range(odd, 50, 150);
        }
}

/* Points past 2^32 begin another scramble: not the first points again. */
static void test_points_do_not_repeat(void **state)
{
    (void)state;
    int same = 0;
    for (uint64_t i = 0; i < 256; i++) {
        float p[4], q[4];
        sample_point(5, i, p);
        sample_point(5, i + (UINT64_C(1) << 32), q);
        for (int d = 0; d < 4; d++)
            same += fabsf(p[d] - q[d]) < 1e-4f;
    }
    assert_true(same < 8);
}

/* Every interval of 1/n holds one of the n points of an aligned block. */
static void expect_stratified(uint32_t key, uint64_t first, uint32_t n)
{
    for (int d = 0; d < 4; d++) {
        uint8_t seen[1024] = {0};
        for (uint64_t i = first; i < first + n; i++) {
            float point[4];
            sample_point(key, i, point);
            uint32_t interval = (uint32_t)(point[d] * (float)n);
            assert_int_equal(seen[interval], 0);
            seen[interval] = 1;
        }
    }
}

static void test_stratified_in_each_dimension(void **state)
{
    (void)state;
    for (size_t k = 0; k < KEYS; k++)
        for (uint32_t n = 1; n <= 1024; n *= 2) {
            expect_stratified(keys[k], 0, n);
            expect_stratified(keys[k], n, n);
            expect_stratified(keys[k], UINT64_C(12345) * n, n);
            expect_stratified(keys[k], (UINT64_C(7) << 32) + n, n);
        }
}

/* Dimensions 0 and 1 of an aligned block of n = across * down points are a (0, 2)-net. */
static void expect_net(uint32_t key, uint64_t first, uint32_t across, uint32_t down)
{
    uint8_t seen[1024] = {0};
    for (uint64_t i = first; i < first + (uint64_t)across * down; i++) {
        float point[4];
        sample_point(key, i, point);
        uint32_t column = (uint32_t)(point[0] * (float)across);
        uint32_t row = (uint32_t)(point[1] * (float)down);
        assert_int_equal(seen[row * across + column], 0);
        seen[row * across + column] = 1;
    }
}

static void test_first_two_dimensions_are_a_net(void **state)
{
    (void)state;
    for (size_t k = 0; k < KEYS; k++)
        for (uint32_t n = 16; n <= 1024; n *= 4)
            for (uint32_t across = 1; across <= n; across *= 2) {
                expect_net(keys[k], 0, across, n / across);
                expect_net(keys[k], n, across, n / across);
            }
}

static void test_hash_is_even(void **state)
{
    (void)state;
    double observed[64] = {0}, expected[64];
    for (uint64_t i = 0; i < 64000; i++)
        observed[sample_hash(i) >> 26]++;
    for (int i = 0; i < 64; i++)
        expected[i] = 1000;
    assert_true(chi_squared_probability(observed, expected, 64) > 1e-4);
    for (int bit = 0; bit < 64; bit++) {
        /* One input bit flips half of the output, roughly. */
        int flipped = 0;
        for (uint64_t i = 0; i < 100; i++)
            flipped += __builtin_popcount(sample_hash(i) ^ sample_hash(i ^ UINT64_C(1) << bit));
        assert_in_range(flipped, 1350, 1850);
    }
}

/* Its mean is 1. */
static double integrand(const float point[4])
{
    double product = 1;
    for (int d = 0; d < 4; d++)
        product *= 1.5707963267948966 * sin(3.141592653589793 * point[d]);
    return product;
}

/* Root mean square error of the mean of n points, over scrambles; `random` NULL: Sobol points. */
static double error_of_mean(uint32_t n, struct random *random)
{
    enum { REPEATS = 64 };
    double sum_of_squares = 0;
    for (uint32_t repeat = 0; repeat < REPEATS; repeat++) {
        double sum = 0;
        for (uint64_t i = 0; i < n; i++) {
            float point[4];
            sample_point(sample_key(repeat, 9, 4), i, point);
            for (int d = 0; d < 4 && random; d++)
                point[d] = random_unit(random);
            sum += integrand(point);
        }
        sum_of_squares += (sum / n - 1) * (sum / n - 1);
    }
    return sqrt(sum_of_squares / REPEATS);
}

static void test_converges_faster_than_random(void **state)
{
    (void)state;
    struct random random = {11};
    double few = error_of_mean(64, NULL), many = error_of_mean(1024, NULL);
    double random_many = error_of_mean(1024, &random);
    print_message("error of 64, 1024 points: %.2e, %.2e; 1024 random points: %.2e\n", few, many,
                  random_many);
    assert_true(many < 0.2 * random_many);
    assert_true(many < 0.125 * few); /* random points: a factor of 1/4 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_range),
        cmocka_unit_test(test_pure_function),
        cmocka_unit_test(test_points_are_those_of_their_indices),
        cmocka_unit_test(test_same_numbers_as_ever),
        cmocka_unit_test(test_seeds_streams_and_sets_are_independent),
        cmocka_unit_test(test_dimensions_are_independent),
        cmocka_unit_test(test_dimensions_are_scrambled_apart),
        cmocka_unit_test(test_points_do_not_repeat),
        cmocka_unit_test(test_stratified_in_each_dimension),
        cmocka_unit_test(test_first_two_dimensions_are_a_net),
        cmocka_unit_test(test_hash_is_even),
        cmocka_unit_test(test_converges_faster_than_random),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
