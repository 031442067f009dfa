/* test_metrics.c: the comparison's metrics against values worked out by hand, their behaviour on
 * identical and on opposite pictures. */
#include "compare/flip.h"
#include "compare/metric.h"

#include "scratch.h"
#include <math.h>

#define SIDE 24
#define PIXELS ((size_t)SIDE * SIDE)

/* Two 24x24 pictures of three channels. */
struct square_pair {
    float planes[6][PIXELS];
    struct picture_pair pair;
};

static void square_fill(struct square_pair *square, size_t picture, float value)
{
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < PIXELS; i++)
            square->planes[3 * picture + c][i] = value;
}

/* Stripes and slopes, with values from 0.1 to 0.8. */
static void square_fill_pattern(struct square_pair *square, size_t picture, float factor)
{
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < PIXELS; i++)
            square->planes[3 * picture + c][i] =
                factor * (0.1f + 0.1f * (float)c + 0.2f * (float)(i / 3 % 2) +
                          0.3f * (float)(i / SIDE) / SIDE);
}

static void square_open(struct square_pair *square)
{
    square->pair = (struct picture_pair){
        .width = SIDE, .height = SIDE, .channel_count = 3, .names = {"R", "G", "B"}};
    for (size_t c = 0; c < 3; c++) {
        square->pair.reference[c] = square->planes[c];
        square->pair.test[c] = square->planes[3 + c];
    }
    square_fill_pattern(square, 0, 1.0f);
    square_fill_pattern(square, 1, 1.0f);
}

static double evaluate(enum metric metric, const struct picture_pair *pair)
{
    struct metric_value value;
    struct error error;
    assert_int_equal(metric_evaluate(metric, pair, &value, &error), PS_OK);
    return value.numbers[0];
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", value, expected, tolerance);
}

static void test_identical_pictures(void **state)
{
    (void)state;
    static const double expected[METRIC_COUNT] = {
        [METRIC_BIAS] = 1.0, [METRIC_PSNR] = INFINITY, [METRIC_SSIM] = 1.0};
    struct square_pair square;
    square_open(&square);
    for (enum metric metric = 0; metric < METRIC_COUNT; metric++)
        assert_true(evaluate(metric, &square.pair) == expected[metric]);
}

static void test_constant_offset(void **state)
{
    (void)state;
    struct square_pair square;
    square_open(&square);
    square_fill(&square, 0, 0.5f);
    square_fill(&square, 1, 0.75f);
    /* sRGB of 0.5 and 0.75: 0.7353570 and 0.8808250. */
    const double display = 0.8808250 - 0.7353570;
    assert_near(evaluate(METRIC_THESIS_RMSE, &square.pair), 3.0 * 255.0 * display, 1e-3);
    assert_near(evaluate(METRIC_REL_RMSE, &square.pair), 0.5, 1e-12);
    assert_near(evaluate(METRIC_RELMSE, &square.pair), 0.0625 / 0.26, 1e-12);
    assert_near(evaluate(METRIC_BIAS, &square.pair), 1.5, 1e-12);
    assert_near(evaluate(METRIC_PSNR, &square.pair), -20.0 * log10(display), 1e-4);
    assert_near(evaluate(METRIC_MAX, &square.pair), 0.25, 0.0);
    assert_near(evaluate(METRIC_P99, &square.pair), 0.25, 0.0);
    /* No variance: only the comparison of means is left, (2 x y + C1) / (x^2 + y^2 + C1). */
    const double x = 0.7353570, y = 0.8808250, c1 = 1e-4;
    assert_near(evaluate(METRIC_SSIM, &square.pair), (2 * x * y + c1) / (x * x + y * y + c1), 1e-6);
}

/* R = 1 2; 0 1 and I = 1 1; 1 3: differences 0 -1 1 2, one channel. */
static void test_two_by_two(void **state)
{
    (void)state;
    float reference[] = {1.0f, 2.0f, 0.0f, 1.0f}, test[] = {1.0f, 1.0f, 1.0f, 3.0f};
    const struct picture_pair pair = {.width = 2,
                                      .height = 2,
                                      .channel_count = 1,
                                      .names = {"Z"},
                                      .reference = {reference},
                                      .test = {test}};
    assert_near(evaluate(METRIC_REL_RMSE, &pair), 1.0, 1e-12); /* sqrt(6 / 6) */
    assert_near(evaluate(METRIC_RELMSE, &pair), (1 / 4.01 + 1 / 0.01 + 4 / 1.01) / 4, 1e-9);
    assert_near(evaluate(METRIC_BIAS, &pair), 1.5, 1e-12);
    assert_near(evaluate(METRIC_MAX, &pair), 2.0, 0.0);
    /* Display values clip at 1: only the third pixel differs, by 1. */
    assert_near(evaluate(METRIC_THESIS_RMSE, &pair), 255.0 * 0.5, 1e-9);
    assert_near(evaluate(METRIC_PSNR, &pair), -10.0 * log10(0.25), 1e-9);
    assert_true(isfinite(evaluate(METRIC_SSIM, &pair)));
    assert_true(isfinite(evaluate(METRIC_FLIP, &pair)));
}

/* 4x3, one channel, R = 1 but for a lamp of 9 at (0, 1), I = R + 0.1 but for I = 50 at the lamp and
 * beside it: six pixels are left out, at the others the difference is 0.1. */
static void test_pixels_left_out(void **state)
{
    (void)state;
    float reference[12], test[12];
    for (size_t i = 0; i < 12; i++) {
        reference[i] = i == 4 ? 9.0f : 1.0f;
        test[i] = i % 4 < 2 ? 50.0f : 1.1f;
    }
    struct picture_pair pair = {.width = 4,
                                .height = 3,
                                .channel_count = 1,
                                .names = {"R"},
                                .reference = {reference},
                                .test = {test}};
    struct error error;
    assert_int_equal(picture_pair_leave_out(&pair, 9.0, &error), PS_OK);
    assert_int_equal(pair.left_out, 6);
    assert_near(evaluate(METRIC_REL_RMSE, &pair), 0.1, 1e-6);
    assert_near(evaluate(METRIC_RELMSE, &pair), 0.01 / 1.01, 1e-6);
    assert_near(evaluate(METRIC_BIAS, &pair), 1.1, 1e-6);
    assert_near(evaluate(METRIC_MAX, &pair), 0.1, 1e-6);
    assert_near(evaluate(METRIC_P99, &pair), 0.1, 1e-6);
}

/* 264 pixels count, of which 1 % are two: the third largest difference. Of all 576, it were the
 * sixth. */
static void test_p99_of_what_counts(void **state)
{
    (void)state;
    struct square_pair square;
    struct error error;
    square_open(&square);
    square_fill(&square, 0, 0.0f);
    square_fill(&square, 1, 0.0f);
    for (size_t i = 0; i < PIXELS / 2; i++)
        square.planes[0][i] = 9.0f;
    for (size_t i = PIXELS - 4; i < PIXELS; i++)
        square.planes[3][i] = 1.0f;
    assert_int_equal(picture_pair_leave_out(&square.pair, 9.0, &error), PS_OK);
    assert_int_equal(square.pair.left_out, PIXELS / 2 + SIDE);
    assert_near(evaluate(METRIC_P99, &square.pair), 1.0, 0.0);
}

static void test_everything_left_out(void **state)
{
    (void)state;
    struct square_pair square;
    struct error error;
    square_open(&square);
    assert_int_equal(picture_pair_leave_out(&square.pair, 1.0, &error), PS_OK);
    assert_int_equal(square.pair.left_out, 0);
    assert_int_equal(picture_pair_leave_out(&square.pair, 0.1, &error), PS_ERROR_INVALID);
}

/* Display values: white against black, of which half does not count. */
static void test_display_values_left_out(void **state)
{
    (void)state;
    float reference[] = {0.0f, 0.0f, 0.0f, 2.0f}, test[] = {1.0f, 0.0f, 0.0f, 0.0f};
    struct picture_pair pair = {.width = 4,
                                .height = 1,
                                .channel_count = 1,
                                .names = {"R"},
                                .reference = {reference},
                                .test = {test}};
    struct error error;
    assert_int_equal(picture_pair_leave_out(&pair, 1.0, &error), PS_OK);
    assert_near(evaluate(METRIC_THESIS_RMSE, &pair), 255.0 * sqrt(0.5), 1e-4);
    assert_near(evaluate(METRIC_PSNR, &pair), -10.0 * log10(0.5), 1e-6);
}

static void test_bias_of_each_channel(void **state)
{
    (void)state;
    struct square_pair square;
    struct metric_value value;
    struct error error;
    square_open(&square);
    for (size_t i = 0; i < PIXELS; i++) {
        square.planes[4][i] *= 2.0f;
        square.planes[2][i] = square.planes[5][i] = 0.0f;
    }
    assert_int_equal(metric_evaluate(METRIC_BIAS, &square.pair, &value, &error), PS_OK);
    assert_int_equal(value.count, 3);
    assert_near(value.numbers[0], 1.0, 1e-12);
    assert_near(value.numbers[1], 2.0, 1e-12);
    assert_true(isnan(value.numbers[2]));
}

/* Of 576 pixels 5 may exceed the percentile: the sixth largest difference is it. */
static void test_p99(void **state)
{
    (void)state;
    struct square_pair square;
    square_open(&square);
    square_fill(&square, 0, 1.0f);
    square_fill(&square, 1, 1.0f);
    for (size_t i = 0; i < 10; i++)
        square.planes[3 + i % 3][40 * i] = 1.0f - (float)i;
    assert_near(evaluate(METRIC_P99, &square.pair), 4.0, 0.0);
    assert_near(evaluate(METRIC_MAX, &square.pair), 9.0, 0.0);
}

/* HyAB of black and white is 100, and 203.4 the largest: 100^0.7 lies beyond the knee at 0.4 of the
 * largest's; constants hold no features. */
static void test_flip_black_and_white(void **state)
{
    (void)state;
    struct square_pair square;
    square_open(&square);
    square_fill(&square, 0, 0.0f);
    square_fill(&square, 1, 1.0f);
    double flip = evaluate(METRIC_FLIP, &square.pair);
    assert_near(flip, 0.967, 1e-3);
    square_fill(&square, 0, 7.0f); /* is clipped */
    square_fill(&square, 1, 0.0f);
    assert_near(evaluate(METRIC_FLIP, &square.pair), flip, 1e-12);
}

/* The picture of a metric has it as its mean. */
static void test_flip_map(void **state)
{
    (void)state;
    static struct square_pair square;
    static float map[PIXELS];
    struct error error;
    double sum = 0.0;
    square_open(&square);
    for (size_t i = 0; i < PIXELS / 2; i++)
        square.pair.test[0][i] = 0.9f;
    assert_int_equal(flip_map(&square.pair, map, &error), PS_OK);
    for (size_t i = 0; i < PIXELS; i++)
        sum += (double)map[i];
    assert_near(sum / PIXELS, evaluate(METRIC_FLIP, &square.pair), 1e-6);
    assert_true(map[0] > 0.1f);
    assert_near((double)map[PIXELS - 1], 0.0, 1e-3);
}

static void test_flip_green_and_blue(void **state)
{
    (void)state;
    struct square_pair square;
    square_open(&square);
    square_fill(&square, 0, 0.0f);
    square_fill(&square, 1, 0.0f);
    for (size_t i = 0; i < PIXELS; i++)
        square.planes[1][i] = square.planes[5][i] = 1.0f;
    assert_near(evaluate(METRIC_FLIP, &square.pair), 1.0, 1e-6);
}

static void test_flip_is_symmetric_and_grows(void **state)
{
    (void)state;
    struct square_pair square;
    double last = 0.0;
    square_open(&square);
    for (float factor = 0.9f; factor > 0.2f; factor -= 0.2f) {
        square_fill_pattern(&square, 0, 1.0f);
        square_fill_pattern(&square, 1, factor);
        double forwards = evaluate(METRIC_FLIP, &square.pair);
        square_fill_pattern(&square, 0, factor);
        square_fill_pattern(&square, 1, 1.0f);
        assert_near(evaluate(METRIC_FLIP, &square.pair), forwards, 1e-12);
        assert_true(forwards > last && forwards < 1.0);
        last = forwards;
    }
}

/* A checkerboard finer than the eye resolves, against one a pixel aside, is seen less than a
 * coarse one is. */
static void test_flip_sees_less_of_fine_patterns(void **state)
{
    (void)state;
    struct square_pair square;
    double seen[2];
    square_open(&square);
    for (size_t k = 0; k < 2; k++) {
        size_t cell = k == 0 ? 1 : 8;
        for (size_t c = 0; c < 3; c++)
            for (size_t i = 0; i < PIXELS; i++) {
                size_t parity = (i % SIDE / cell + i / SIDE / cell) % 2;
                square.planes[c][i] = (float)parity;
                square.planes[3 + c][i] = (float)(1 - parity);
            }
        seen[k] = evaluate(METRIC_FLIP, &square.pair);
    }
    assert_true(seen[0] < 0.5 * seen[1]);
}

static void test_ssim_of_an_inverted_picture_is_low(void **state)
{
    (void)state;
    struct square_pair square;
    square_open(&square);
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < PIXELS; i++)
            square.planes[3 + c][i] = 1.0f - square.planes[c][i];
    assert_true(evaluate(METRIC_SSIM, &square.pair) < 0.1);
}

static void test_non_finite_is_refused(void **state)
{
    (void)state;
    struct square_pair square;
    struct error error;
    square_open(&square);
    assert_int_equal(picture_pair_check_finite(&square.pair, &error), PS_OK);
    square.planes[4][2 * SIDE + 5] = NAN;
    square.planes[3][3 * SIDE] = INFINITY;
    square.pair.left = 100;
    assert_int_equal(picture_pair_check_finite(&square.pair, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "the test picture holds 2 samples"));
    assert_non_null(strstr(error.text, "'G' at x=105, y=2"));
}

static void test_black_reference(void **state)
{
    (void)state;
    struct square_pair square;
    struct metric_value value;
    struct error error;
    square_open(&square);
    square_fill(&square, 0, 0.0f);
    assert_int_equal(metric_evaluate(METRIC_REL_RMSE, &square.pair, &value, &error),
                     PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "zero everywhere"));
    assert_int_equal(metric_evaluate(METRIC_BIAS, &square.pair, &value, &error), PS_ERROR_INVALID);
    assert_int_equal(metric_evaluate(METRIC_PSNR, &square.pair, &value, &error), PS_OK);
}

static void test_crop(void **state)
{
    (void)state;
    struct square_pair square;
    struct error error;
    square_open(&square);
    square_fill(&square, 0, 1.0f);
    square_fill(&square, 1, 1.0f);
    square.planes[4][6 * SIDE + 9] = 3.0f;
    assert_int_equal(picture_pair_crop(&square.pair, (struct rectangle){20, 0, 5, 1}, &error),
                     PS_ERROR_INVALID);
    assert_int_equal(picture_pair_crop(&square.pair, (struct rectangle){8, 5, 2, 3}, &error),
                     PS_OK);
    assert_int_equal(square.pair.width, 2);
    assert_near(square.planes[4][1 * 2 + 1], 3.0, 0.0);
    assert_near(evaluate(METRIC_REL_RMSE, &square.pair), sqrt(4.0 / 18.0), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identical_pictures),
        cmocka_unit_test(test_constant_offset),
        cmocka_unit_test(test_two_by_two),
        cmocka_unit_test(test_pixels_left_out),
        cmocka_unit_test(test_p99_of_what_counts),
        cmocka_unit_test(test_everything_left_out),
        cmocka_unit_test(test_display_values_left_out),
        cmocka_unit_test(test_bias_of_each_channel),
        cmocka_unit_test(test_p99),
        cmocka_unit_test(test_flip_black_and_white),
        cmocka_unit_test(test_flip_map),
        cmocka_unit_test(test_flip_green_and_blue),
        cmocka_unit_test(test_flip_is_symmetric_and_grows),
        cmocka_unit_test(test_flip_sees_less_of_fine_patterns),
        cmocka_unit_test(test_ssim_of_an_inverted_picture_is_low),
        cmocka_unit_test(test_non_finite_is_refused),
        cmocka_unit_test(test_black_reference),
        cmocka_unit_test(test_crop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
