/* test_bilateral.c: the denoiser `bilateral` on G-buffers made by hand. */
#include "support/denoiser_picture.h"
#include "support/one_strategy.h"
#include "support/random.h"

#include <math.h>
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROUNDING 2e-5f /* of a mean of equal numbers, relative */

/* --- against the formula, pixel by pixel in double precision --- */

static double biweight(double s)
{
    return s < 1 ? (1 - s) * (1 - s) : 0;
}

struct expectation {
    int reach;
    double sigma, normal_degrees, distance;
};

static double expected_weight(const struct picture *picture, const struct expectation *e, int p,
                              int q)
{
    ps_vec3 np = ps_normalize(vector_at(picture->normal, p));
    ps_vec3 nq = ps_normalize(vector_at(picture->normal, q));
    ps_vec3 d = ps_subtract(vector_at(picture->position, q), vector_at(picture->position, p));
    double over = ps_dot(d, np), under = ps_dot(d, nq);
    int dx = q % WIDTH - p % WIDTH, dy = q / WIDTH - p / WIDTH;
    double bend = (1 - ps_dot(np, nq)) / (1 - cos(e->normal_degrees * 3.14159265358979 / 180));
    return exp(-0.5 * (dx * dx + dy * dy) / (e->sigma * e->sigma)) * biweight(bend) *
           biweight((over * over + under * under) / (e->distance * e->distance));
}

static double expected_light(const struct picture *picture, const struct expectation *e, int p,
                             int channel)
{
    double sum = 0, total = 0;
    const float *albedo = picture->albedo[channel];
    if (isinf(picture->depth[p]) || albedo[p] < 1e-3f)
        return picture->light[channel][p];
    for (int y = p / WIDTH - e->reach; y <= p / WIDTH + e->reach; y++)
        for (int x = p % WIDTH - e->reach; x <= p % WIDTH + e->reach; x++) {
            int q = y * WIDTH + x;
            bool inside = x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT;
            if (!inside || isinf(picture->depth[q]) || albedo[q] < 1e-3f)
                continue;
            double weight = expected_weight(picture, e, p, q);
            sum += weight * picture->light[channel][q] / albedo[q];
            total += weight;
        }
    return albedo[p] * sum / total;
}

static void expect_formula(const char *choice, struct expectation expectation)
{
    struct picture *before = wild_picture(7), *after = wild_picture(7);
    double worst = 0;
    denoise(after, choice, 2);
    for (int p = 0; p < PIXELS; p++)
        for (int c = 0; c < 3; c++) {
            double expected = expected_light(before, &expectation, p, c);
            worst = fmax(worst, fabs(after->light[c][p] - expected) / fmax(expected, 1e-3));
        }
    print_message("%s: off by %.1e at most\n", choice, worst);
    assert_true(worst < 1e-4);
    free(before);
    free(after);
}

static void test_formula(void **state)
{
    (void)state;
    expect_formula("denoiser=bilateral:size=7,sigma=1.5,normal=40,distance=0.3",
                   (struct expectation){3, 1.5, 40, 0.3});
    expect_formula("denoiser=bilateral:size=3,sigma=100,normal=90,distance=1e6",
                   (struct expectation){1, 100, 90, 1e6});
    /* Automatic: 0.3 (reach - 1) + 0.8, and 1 % of the radius, 100. */
    expect_formula("denoiser=bilateral", (struct expectation){4, 1.7, 30, 1});
    expect_formula("denoiser=bilateral:size=33,distance=2", (struct expectation){16, 5.3, 30, 2});
}

/* --- what it is for --- */

static void test_constant_light_stays(void **state)
{
    (void)state;
    struct picture *before = wild_picture(3), *after = wild_picture(3);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++)
            before->light[c][i] = after->light[c][i] = 2.5f * before->albedo[c][i];
    denoise(after, "denoiser=bilateral:size=15,normal=80,distance=10", 2);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++)
            assert_true(fabsf(after->light[c][i] - before->light[c][i]) <=
                        ROUNDING * before->light[c][i]);
    free(before);
    free(after);
}

/* The right half of the floor shines a hundred times brighter. Whether light crosses. */
static bool crosses(struct picture *picture, const char *choice)
{
    float off = 0;
    for (int i = 0; i < PIXELS; i++)
        if (i % WIDTH >= WIDTH / 2)
            picture->light[1][i] = 100;
    denoise(picture, choice, 1);
    for (int i = 0; i < PIXELS; i++) {
        float expected = i % WIDTH >= WIDTH / 2 ? 100.0f : 1.0f;
        off = fmaxf(off, fabsf(picture->light[1][i] / expected - 1));
    }
    free(picture);
    return off > ROUNDING;
}

static void test_edges_stop_the_blur(void **state)
{
    (void)state;
    assert_true(crosses(bent_floor(0, 0), "denoiser=bilateral"));
    assert_false(crosses(bent_floor(90, 0), "denoiser=bilateral"));
    assert_false(crosses(bent_floor(90, 0), "denoiser=bilateral:size=33,normal=90,distance=1000"));
    assert_false(crosses(bent_floor(20, 0), "denoiser=bilateral:normal=19,distance=1000"));
    assert_true(crosses(bent_floor(20, 0), "denoiser=bilateral:normal=21,distance=1000"));
    assert_false(crosses(bent_floor(0, 0.3f), "denoiser=bilateral:distance=0.3"));
    assert_true(crosses(bent_floor(0, 0.3f), "denoiser=bilateral:distance=0.5"));
}

struct moments {
    double mean, deviation;
};

static struct moments noise_after(const char *choice)
{
    struct random random = {11};
    struct picture *picture = level_floor();
    struct moments moments = {0, 0};
    for (int i = 0; i < PIXELS; i++)
        picture->light[2][i] = random_between(&random, 0.0f, 2.0f);
    if (choice)
        denoise(picture, choice, 1);
    for (int i = 0; i < PIXELS; i++) {
        moments.mean += picture->light[2][i] / PIXELS;
        moments.deviation += pow(picture->light[2][i] - 1, 2) / PIXELS;
    }
    moments.deviation = sqrt(moments.deviation);
    print_message("%s: mean %.4f, deviation %.4f\n", choice ? choice : "before", moments.mean,
                  moments.deviation);
    free(picture);
    return moments;
}

/* The mean may move by what the border's pixels count more or less: half a per cent here. */
static void test_noise_falls_and_the_mean_stays(void **state)
{
    (void)state;
    double mean = noise_after(NULL).mean, before = 0.5774; /* 1 / sqrt(3) */
    static const char *const choices[] = {"denoiser=bilateral:size=3", "denoiser=bilateral:size=5",
                                          "denoiser=bilateral:size=9",
                                          "denoiser=bilateral:size=33"};
    for (int i = 0; i < 4; i++) {
        struct moments after = noise_after(choices[i]);
        assert_true(after.deviation < 0.75 * before);
        assert_true(fabs(after.mean - mean) < 0.005);
        before = after.deviation;
    }
}

/* A channel that the surface does not reflect keeps what it has, and gives none of it. */
static void test_black_channels_take_no_part(void **state)
{
    (void)state;
    struct picture *picture = level_floor();
    int black = 10 * WIDTH + 70;
    picture->albedo[1][black] = 0;
    picture->light[1][black] = 1000;
    denoise(picture, "denoiser=bilateral:size=9", 1);
    for (int i = 0; i < PIXELS; i++)
        assert_true(i == black ? picture->light[1][i] == 1000.0f
                               : fabsf(picture->light[1][i] - 1) <= ROUNDING);
    free(picture);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    struct picture *one = wild_picture(5), *three = wild_picture(5);
    denoise(one, "denoiser=bilateral:size=11", 1);
    denoise(three, "denoiser=bilateral:size=11", 3);
    assert_memory_equal(one, three, sizeof *one);
    free(one);
    free(three);
}

static void test_even_sizes_are_refused(void **state)
{
    (void)state;
    struct bare_host bare;
    bare_host_create(&bare, 1);
    struct strategy strategy = strategy_of("denoiser=bilateral:size=8");
    assert_int_equal(strategy_start(&strategy, &bare.host), PS_ERROR_INVALID);
    assert_string_equal(bare.why, "size must be odd, got 8");
    strategy_release(&strategy);
    bare_host_release(&bare);
}

static void test_stops_when_cancelled(void **state)
{
    (void)state;
    struct picture *picture = wild_picture(5);
    denoise_cancelled(picture, "denoiser=bilateral:size=11", 2);
    free(picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formula),
        cmocka_unit_test(test_constant_light_stays),
        cmocka_unit_test(test_edges_stop_the_blur),
        cmocka_unit_test(test_noise_falls_and_the_mean_stays),
        cmocka_unit_test(test_black_channels_take_no_part),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_even_sizes_are_refused),
        cmocka_unit_test(test_stops_when_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
