/* test_edge_interpolation.c: the indirect light of camera samples, from that of pixels of a tile
 * (view/edge_interpolation.h). */
#include "view/edge_interpolation.h"

#include <psplat/tile.h>

#include "gbuffer_fixture.h"

#define FLOOR 1u
#define WALL 2u
#define COLUMN 8u /* of the pixel that samples lie in */
#define ROW 4u

static int open_gbuffer(void **state)
{
    (void)state;
    struct error error;
    int failed = create_gbuffer(PS_TILE_SIZE, PS_TILE_SIZE);
    return failed || gbuffer_prepare_splatted(&gbuffer, &error) != PS_OK;
}

static ps_hit hit_at(uint32_t object, float x, float y)
{
    return (ps_hit){.position = {x, y, object == WALL ? 1.0f : 0.0f},
                    .normal = {0, 0, 1},
                    .albedo = {0.5f, 0.5f, 0.5f},
                    .object = object};
}

static void see(uint32_t lane, uint32_t object, float x, float y, float light)
{
    ps_tile *tile = &gbuffer.tiles[0];
    ps_hit hit = hit_at(object, x, y);
    gbuffer_store(tile, lane, &hit, (ps_rgb){1, 1, 1}, 1);
    tile->irradiance_r[lane] = tile->irradiance_g[lane] = tile->irradiance_b[lane] = light;
    tile->weight[lane] = 1.0f;
    gbuffer_splatted(&gbuffer, 0, 1)[lane] = 3.0f * light;
}

/* The light of a stochastic sample that sees the floor there; what was splatted is interpolated as
 * that is. */
static float light_of_sample(float x, float y)
{
    static ps_tile tile;
    static float splatted[3 * PS_TILE_PIXELS];
    struct gbuffer samples = {.tiles = &tile, .tile_count = 1, .splatted = splatted};
    struct edge_neighbours neighbours;
    ps_hit hit = hit_at(FLOOR, x, y);
    gbuffer_store(&tile, 0, &hit, (ps_rgb){1, 1, 1}, 1);
    edge_neighbours_find(&gbuffer, COLUMN, ROW, &neighbours);
    edge_interpolate(&gbuffer, &neighbours, COLUMN, ROW, true, &samples, 0);
    float light = tile.irradiance_g[0];
    assert_float_equal(gbuffer_splatted(&samples, 0, 1)[0] / light, 3.0, 1e-5);
    return light;
}

/* Pixels of row 0 see the floor, one unit apart; all others a wall. */
static void fill(void)
{
    gbuffer_clear_tile(&gbuffer, 0);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        float column = (float)(lane % PS_TILE_SIZE);
        if (lane < PS_TILE_SIZE)
            see(lane, FLOOR, column, 0.0f, 1.0f + column);
        else
            see(lane, WALL, column, (float)(lane / PS_TILE_SIZE), 50.0f);
    }
}

/* No pixel around sees the floor: what those of the tile see nearest to the sample is its light. */
static void test_from_the_tile(void **state)
{
    (void)state;
    fill();
    assert_float_equal(light_of_sample(3.0f, 0.0f), 4.0, 1e-4);
    assert_float_equal(light_of_sample(3.5f, 0.0f), 4.5, 0.2);
    assert_float_equal(light_of_sample(10.5f, 0.0f), 11.5, 0.2);
}

/* Half of the tile sees a caustic, 20 units away and 100 times as bright. */
static void test_far_light_stays_far(void **state)
{
    (void)state;
    fill();
    for (uint32_t lane = PS_TILE_PIXELS / 2; lane < PS_TILE_PIXELS; lane++)
        see(lane, FLOOR, 5.0f, 20.0f + 0.1f * (float)(lane % PS_TILE_SIZE), 500.0f);
    assert_float_equal(light_of_sample(4.5f, 0.0f), 5.5, 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_from_the_tile),
        cmocka_unit_test(test_far_light_stays_far),
    };
    return cmocka_run_group_tests(tests, open_gbuffer, close_gbuffer);
}
