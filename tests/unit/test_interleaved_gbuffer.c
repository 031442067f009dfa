/* test_interleaved_gbuffer.c: the pixels that splats light: where they lie, what they take over,
 * how they join.
 *
 * The G-buffer is made by hand: a floor, beside it a wall, a step up, and nothing. */
#include "splat/interleaved.h"
#include "support/workers.h"

#include <math.h>
#include <psplat/host.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 75
#define HEIGHT 50
#define WALL 30 /* columns: floor, then wall, then a step as high as ten pixels, then nothing */
#define STEP 45
#define VOID 60

struct bench {
    struct gbuffer gbuffer;
    struct interleaved interleaved;
    struct workers *workers;
};

static void see(ps_tile *tile, uint32_t lane, uint32_t x, uint32_t y)
{
    bool wall = x >= WALL && x < STEP;
    ps_hit hit = {.position = {(float)x, x >= STEP ? 10.0f : 0.0f, (float)y}, .object = 1};
    if (wall)
        hit.position = (ps_vec3){WALL, (float)(x - WALL), (float)y};
    hit.normal = wall ? (ps_vec3){-1, 0, 0} : (ps_vec3){0, 1, 0};
    if (x < VOID)
        gbuffer_store(tile, lane, &hit, (ps_rgb){1, 1, 1}, 5);
}

static struct bench open_bench(uint32_t interleave)
{
    struct bench bench;
    struct error error;
    assert_int_equal(gbuffer_create(gbuffer_layout(WIDTH, HEIGHT), &bench.gbuffer, &error), PS_OK);
    for (uint32_t tile = 0; tile < bench.gbuffer.tile_count; tile++) {
        gbuffer_clear_tile(&bench.gbuffer, tile);
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            if (gbuffer_pixel(&bench.gbuffer, tile, lane, &x, &y))
                see(&bench.gbuffer.tiles[tile], lane, x, y);
        }
    }
    assert_int_equal(interleaved_create(interleaved_layout(&bench.gbuffer, interleave),
                                        &bench.interleaved, &error),
                     PS_OK);
    bench.workers = start_workers(2);
    interleaved_fill(&bench.interleaved, &bench.gbuffer, bench.workers);
    return bench;
}

static void close_bench(struct bench *bench)
{
    workers_destroy(bench->workers);
    interleaved_release(&bench->interleaved);
    gbuffer_release(&bench->gbuffer);
}

static const ps_tile *tile_at(const struct bench *bench, uint32_t x, uint32_t y, uint32_t *lane)
{
    *lane = y % PS_TILE_SIZE * PS_TILE_SIZE + x % PS_TILE_SIZE;
    return &bench->gbuffer.tiles[y / PS_TILE_SIZE * bench->gbuffer.tiles_across + x / PS_TILE_SIZE];
}

/* Every pixel has one lane, in the subset that its column and row say, with the G-buffer's surface;
 * other lanes see nothing. */
static void test_every_pixel_has_a_lane(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= PS_MOST_INTERLEAVE; n++) {
        struct bench bench = open_bench(n);
        static uint8_t met[HEIGHT][WIDTH];
        memset(met, 0, sizeof met);
        uint32_t each = bench.interleaved.tiles_across * bench.interleaved.tiles_down;
        for (uint32_t tile = 0; tile < bench.interleaved.tile_count; tile++)
            for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
                uint32_t x, y, there;
                float position = bench.interleaved.tiles[tile].position_x[lane];
                if (!interleaved_pixel(&bench.interleaved, tile, lane, &x, &y)) {
                    assert_true(position >= BOUNDS_NOWHERE);
                    continue;
                }
                met[y][x]++;
                assert_int_equal(tile / each, y % n * n + x % n);
                assert_true(position == tile_at(&bench, x, y, &there)->position_x[there]);
            }
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
            assert_int_equal(met[i / WIDTH][i % WIDTH], 1);
        close_bench(&bench);
    }
}

/* Sums that tell the subset: s + 1; half of that as weight. */
static void light_subsets(struct interleaved *interleaved)
{
    uint32_t each = interleaved->tiles_across * interleaved->tiles_down;
    for (uint32_t tile = 0; tile < interleaved->tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            float value = (float)(tile / each + 1);
            interleaved->tiles[tile].irradiance_r[lane] = value;
            interleaved->tiles[tile].irradiance_g[lane] = 2 * value;
            interleaved->tiles[tile].irradiance_b[lane] = 3 * value;
            interleaved->tiles[tile].weight[lane] = 0.5f * value;
        }
}

static void expect_near(float value, double expected)
{
    if (fabs((double)value - expected) > 1e-5 * fabs(expected))
        fail_msg("%.9g, expected %.9g", (double)value, expected);
}

/* Inside of a plane every subset weighs the same. */
static void test_joins_all_subsets_alike(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= PS_MOST_INTERLEAVE; n++) {
        struct bench bench = open_bench(n);
        light_subsets(&bench.interleaved);
        interleaved_join(&bench.interleaved, &bench.gbuffer, bench.workers);
        double mean = 0.5 * (n * n + 1);
        for (uint32_t y = n / 2; y < HEIGHT - n / 2; y++)
            for (uint32_t x = n / 2; n > 1 && x < WALL - n / 2; x++) {
                uint32_t lane;
                const ps_tile *tile = tile_at(&bench, x, y, &lane);
                expect_near(tile->irradiance_r[lane], mean);
                expect_near(tile->irradiance_g[lane], 2 * mean);
                expect_near(tile->irradiance_b[lane], 3 * mean);
                expect_near(tile->weight[lane], 0.5 * mean);
            }
        close_bench(&bench);
    }
}

/* Light by columns: 1 on the floor, 2 on the wall, 4 on the step. Nothing crosses, to the last
 * pixel, and what sees nothing gets nothing. */
static void test_surfaces_do_not_mix(void **state)
{
    (void)state;
    struct bench bench = open_bench(4);
    for (uint32_t tile = 0; tile < bench.interleaved.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            interleaved_pixel(&bench.interleaved, tile, lane, &x, &y);
            bench.interleaved.tiles[tile].irradiance_r[lane] = x < WALL ? 1 : x < STEP ? 2 : 4;
        }
    interleaved_join(&bench.interleaved, &bench.gbuffer, bench.workers);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            uint32_t lane;
            const ps_tile *tile = tile_at(&bench, x, y, &lane);
            if (x >= VOID)
                assert_true(tile->irradiance_r[lane] == 0.0f);
            else
                expect_near(tile->irradiance_r[lane], x < WALL ? 1 : x < STEP ? 2 : 4);
        }
    close_bench(&bench);
}

/* Without interleaving the sums come back as they are, and add to what is there. */
static void test_one_subset_is_a_copy(void **state)
{
    (void)state;
    struct bench bench = open_bench(1);
    for (uint32_t tile = 0; tile < bench.interleaved.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
            bench.interleaved.tiles[tile].irradiance_g[lane] = 0.1f * (float)(tile * 7 + lane);
    interleaved_join(&bench.interleaved, &bench.gbuffer, bench.workers);
    interleaved_join(&bench.interleaved, &bench.gbuffer, bench.workers);
    for (uint32_t tile = 0; tile < bench.interleaved.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y, there;
            float value = bench.interleaved.tiles[tile].irradiance_g[lane];
            if (interleaved_pixel(&bench.interleaved, tile, lane, &x, &y) && x < VOID)
                assert_true(tile_at(&bench, x, y, &there)->irradiance_g[there] == value + value);
        }
    close_bench(&bench);
}

/* Where it is kept apart, the tiles get its weight alone. */
static void test_light_of_splats_apart(void **state)
{
    (void)state;
    struct bench bench = open_bench(3);
    struct error error;
    assert_int_equal(gbuffer_prepare_splatted(&bench.gbuffer, &error), PS_OK);
    light_subsets(&bench.interleaved);
    interleaved_join(&bench.interleaved, &bench.gbuffer, bench.workers);
    uint32_t lane;
    const ps_tile *tile = tile_at(&bench, 20, 20, &lane);
    uint32_t index = (uint32_t)(tile - bench.gbuffer.tiles);
    for (int c = 0; c < 3; c++)
        expect_near(gbuffer_splatted(&bench.gbuffer, index, c)[lane], (c + 1) * 5.0);
    expect_near(tile->weight[lane], 2.5);
    assert_true(tile->irradiance_r[lane] == 0.0f && tile->irradiance_b[lane] == 0.0f);
    gbuffer_clear_indirect(&bench.gbuffer);
    assert_true(gbuffer_splatted(&bench.gbuffer, index, 2)[lane] == 0.0f);
    close_bench(&bench);
}

/* Blocks are bounded by their own pixels: as small as 4 pixels of their subset. */
static void test_blocks_are_bounded(void **state)
{
    (void)state;
    struct bench bench = open_bench(2);
    size_t empty = 0;
    for (uint32_t tile = 0; tile < bench.interleaved.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            const struct interleaved_tile *pixels = &bench.interleaved.tiles[tile];
            const struct bounds *blocks = &pixels->blocks;
            uint32_t block = lane / INTERLEAVED_BLOCK;
            float z = pixels->position_z[lane];
            empty += !(blocks->center_z[block] < BOUNDS_NOWHERE);
            if (!(z < BOUNDS_NOWHERE))
                continue;
            assert_true(fabsf(z - blocks->center_z[block]) <= blocks->extent_z[block]);
            assert_true(blocks->extent_z[block] < 3.01f);
            assert_true(blocks->normal_low_x[block] <= pixels->normal_x[lane]);
            assert_true(blocks->normal_high_y[block] >= pixels->normal_y[lane]);
        }
    assert_true(empty > 0);
    close_bench(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_pixel_has_a_lane),
        cmocka_unit_test(test_joins_all_subsets_alike),
        cmocka_unit_test(test_surfaces_do_not_mix),
        cmocka_unit_test(test_one_subset_is_a_copy),
        cmocka_unit_test(test_light_of_splats_apart),
        cmocka_unit_test(test_blocks_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
