/* test_allocation.c: how samples are shared out among tiles, and among the points of one
 * (plugins/estimator/shared/allocation.h, sample_factors.h). */
#include "plugins/estimator/shared/allocation.h"
#include "plugins/estimator/shared/sample_factors.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include <cmocka.h>

#define TILES 64

/* --- tiles --- */

static const struct allocation_limits limits = {.first = 4, .samples = 16, .least = 10, .most = 64};

/* Tiles of more and more noise, alike otherwise. */
static void make_pilots(struct tile_pilot pilots[TILES])
{
    for (int i = 0; i < TILES; i++)
        pilots[i] = (struct tile_pilot){
            .points = 256,
            .factors = 256.0f,
            .brightness = 1.0f,
            .noise = 0.01f * (float)(1 + i * i),
            .variation = 0.01f,
        };
}

static double mean_samples(const struct allocation *allocation, const struct tile_pilot *pilots)
{
    double sum = 0.0, points = 0.0;
    for (int i = 0; i < TILES; i++) {
        uint32_t samples = allocated_samples(allocation, &pilots[i]);
        assert_in_range(samples, allocation->limits.least, allocation->limits.most);
        sum += (double)allocation->limits.first * (double)pilots[i].points;
        sum += (double)(samples - allocation->limits.first) * (double)pilots[i].factors;
        points += (double)pilots[i].points;
    }
    return sum / points;
}

static void test_tiles_share_out_what_there_is(void **state)
{
    (void)state;
    struct tile_pilot pilots[TILES];
    make_pilots(pilots);
    struct allocation even = allocation_for(&limits, pilots, TILES);
    double mean = mean_samples(&even, pilots);
    assert_true(mean > 15.0 && mean <= 16.0);
    assert_true(allocated_samples(&even, &pilots[TILES - 1]) >
                allocated_samples(&even, &pilots[TILES / 2]));

    for (int i = TILES / 2; i < TILES; i++)
        pilots[i].factors = 2.0f * 256.0f;
    struct allocation uneven = allocation_for(&limits, pilots, TILES);
    mean = mean_samples(&uneven, pilots);
    assert_true(mean > 15.0 && mean <= 16.0);
    assert_true(allocated_samples(&uneven, &pilots[TILES - 1]) <
                allocated_samples(&even, &pilots[TILES - 1]));
}

static void test_tiles_without_noise_have_as_many_each(void **state)
{
    (void)state;
    struct tile_pilot pilots[2] = {{.points = 256, .factors = 256.0f, .brightness = 1.0f},
                                   {.points = 3, .factors = 3.0f, .brightness = 2.0f}};
    struct allocation allocation = allocation_for(&limits, pilots, 2);
    assert_int_equal(allocated_samples(&allocation, &pilots[0]), limits.samples);
    assert_int_equal(allocated_samples(&allocation, &pilots[1]), limits.samples);
}

/* --- points --- */

/* A floor, with a post of one pixel's width that stands in front of it in column 5. */
static void make_points(ps_points *points, bool has_post)
{
    points->count = PS_TILE_PIXELS;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        float x = (float)(lane % PS_TILE_SIZE), y = (float)(lane / PS_TILE_SIZE);
        bool is_post = has_post && lane % PS_TILE_SIZE == 5;
        points->lanes[lane] = lane;
        points->positions[lane] = (ps_vec3){x, is_post ? 4.0f : 0.0f, y};
        points->normals[lane] = is_post ? (ps_vec3){0, 0, 1} : (ps_vec3){0, 1, 0};
    }
}

static void test_points_of_one_surface_have_the_same(void **state)
{
    (void)state;
    ps_points points;
    float factors[PS_TILE_PIXELS];
    make_points(&points, false);
    sample_factors(&points, factors);
    for (size_t i = 0; i < points.count; i++)
        assert_true(factors[i] == 1.0f);
}

static void test_points_of_what_is_thin_have_more(void **state)
{
    (void)state;
    ps_points points;
    float factors[PS_TILE_PIXELS];
    make_points(&points, true);
    sample_factors(&points, factors);
    for (size_t i = 0; i < points.count; i++) {
        bool is_post = points.lanes[i] % PS_TILE_SIZE == 5;
        assert_true(is_post ? factors[i] >= 2.0f : factors[i] < 1.2f);
        assert_true(factors[i] <= (float)SAMPLE_FACTOR_MOST);
    }
}

/* Points that see nothing around them count as unlike. */
static void test_a_point_alone_has_most(void **state)
{
    (void)state;
    ps_points points;
    float factors[PS_TILE_PIXELS];
    make_points(&points, false);
    points.count = 1;
    points.lanes[0] = 137;
    sample_factors(&points, factors);
    assert_true(factors[0] == (float)SAMPLE_FACTOR_MOST);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tiles_share_out_what_there_is),
        cmocka_unit_test(test_tiles_without_noise_have_as_many_each),
        cmocka_unit_test(test_points_of_one_surface_have_the_same),
        cmocka_unit_test(test_points_of_what_is_thin_have_more),
        cmocka_unit_test(test_a_point_alone_has_most),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
