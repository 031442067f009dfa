/* test_point_tiles.c: points that are no pixels find their way into tiles and back, for any number
 * of them. */
#include "splat/point_tiles.h"
#include "splat/pyramid.h"
#include "support/workers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static struct interleaved fill(size_t n, struct workers *workers)
{
    struct interleaved tiles;
    struct error error;
    ps_vec3 *positions = malloc(n * sizeof *positions), *normals = malloc(n * sizeof *normals);
    assert_non_null(positions);
    assert_non_null(normals);
    for (size_t i = 0; i < n; i++) {
        positions[i] = (ps_vec3){(float)i, 1, 2};
        normals[i] = (ps_vec3){0, 0, 1};
    }
    assert_int_equal(interleaved_create(point_tiles_layout(n), &tiles, &error), PS_OK);
    point_tiles_fill(&tiles, positions, normals, workers);
    free(positions);
    free(normals);
    return tiles;
}

/* Each point is in one lane, all others show nothing, and what a lane is given is its point's. */
static void check(size_t n, struct workers *workers)
{
    struct interleaved tiles = fill(n, workers);
    ps_rgb *irradiance = calloc(n, sizeof *irradiance);
    size_t there = 0;
    assert_non_null(irradiance);
    assert_int_equal(tiles.subsets, 1);
    assert_int_equal(tiles.tile_count, tiles.tiles_across * tiles.tiles_down);
    for (uint32_t i = 0; i < tiles.tile_count; i++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            struct interleaved_tile *tile = &tiles.tiles[i];
            assert_true(tile->irradiance_g[lane] == 0.0f);
            if (!(tile->position_x[lane] < BOUNDS_NOWHERE))
                continue;
            tile->irradiance_g[lane] = tile->position_x[lane] + 1.0f;
            there++;
        }
    assert_int_equal(there, n);
    point_tiles_read(&tiles, irradiance);
    for (size_t i = 0; i < n; i++)
        assert_true(irradiance[i].g == (float)i + 1.0f);
    free(irradiance);
    interleaved_release(&tiles);
}

static void test_any_number(void **state)
{
    (void)state;
    struct workers *workers = start_workers(2);
    static const size_t counts[] = {1, 255, 256, 257, 1024, 4096, 4097, 20000, 65536, 65537};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        check(counts[i], workers);
    workers_destroy(workers);
}

/* Sixteen tiles that follow each other lie below one node of the pyramid. */
static void test_runs_share_nodes(void **state)
{
    (void)state;
    struct workers *workers = start_workers(2);
    struct interleaved tiles = fill((size_t)64 * PS_TILE_PIXELS, workers);
    assert_int_equal(tiles.tile_count, 64);
    for (uint32_t i = 0; i < tiles.tile_count; i++) {
        uint32_t column = i % tiles.tiles_across / PYRAMID_GROUP;
        uint32_t row = i / tiles.tiles_across / PYRAMID_GROUP;
        uint32_t node = row * (tiles.tiles_across / PYRAMID_GROUP) + column;
        uint32_t run = (uint32_t)tiles.tiles[i].position_x[0] / PS_TILE_PIXELS / 16;
        assert_int_equal(run, node);
    }
    interleaved_release(&tiles);
    workers_destroy(workers);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_number),
        cmocka_unit_test(test_runs_share_nodes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
