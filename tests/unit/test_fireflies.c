/* test_fireflies.c: light that single pixels found by chance, shared out. A tile shows a plane,
 * whose right half may be another surface. */
#include "view/fireflies.h"

#include <psplat/tile.h>

#include "gbuffer_fixture.h"

#define BRIGHT 115u /* a lane of the left half */
#define RIGHT 8u    /* column where the right half begins */

static int open_gbuffer(void **state)
{
    (void)state;
    return create_gbuffer(PS_TILE_SIZE, PS_TILE_SIZE);
}

static ps_tile *tile(void)
{
    return &gbuffer.tiles[0];
}

static bool is_right(uint32_t lane)
{
    return lane % PS_TILE_SIZE >= RIGHT;
}

/* All have the irradiance 1, 2, 3, and show what they do by chance or not. The right half is
 * `height` above the left one. */
static void fill(bool stochastic, float height)
{
    gbuffer_clear_tile(&gbuffer, 0);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        ps_hit hit = {.normal = {0, 0, 1}, .albedo = {0.5f, 0.5f, 0.5f}};
        hit.position.x = (float)(lane % PS_TILE_SIZE);
        hit.position.y = (float)(lane / PS_TILE_SIZE);
        hit.position.z = is_right(lane) ? height : 0.0f;
        gbuffer_store(tile(), lane, &hit, (ps_rgb){1, 1, 1}, 1);
        gbuffer.choice[lane] = stochastic ? CHOSEN_BY_LENS_OR_GLOSS : CHOSEN_BY_NOTHING;
        ps_add_irradiance(tile(), lane, (ps_rgb){1, 2, 3});
    }
}

static void brighten(uint32_t lane, float factor)
{
    tile()->irradiance_r[lane] *= factor;
    tile()->irradiance_g[lane] *= factor;
    tile()->irradiance_b[lane] *= factor;
}

static double sum(const float *plane)
{
    double total = 0.0;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        total += (double)plane[lane];
    return total;
}

/* The firefly keeps so many times what the others had, and these have the rest, with its
 * colours. */
static void expect_shared_out(bool stochastic, double times)
{
    double rest = 100.0 - times;
    fill(stochastic, 0.0f);
    brighten(BRIGHT, 100.0f);
    fireflies_spread(&gbuffer, 0);
    assert_float_equal(tile()->irradiance_g[BRIGHT], 2.0 * times, 1e-4);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (lane != BRIGHT) {
            assert_float_equal(tile()->irradiance_r[lane], 1.0 + rest / 255.0, 1e-4);
            assert_float_equal(tile()->irradiance_b[lane], 3.0 + 3 * rest / 255.0, 1e-4);
        }
    assert_float_equal(sum(tile()->irradiance_r), 355.0, 1e-2);
    assert_float_equal(sum(tile()->irradiance_g), 710.0, 1e-2);
}

static void test_shared_out(void **state)
{
    (void)state;
    expect_shared_out(true, 2.0);
    expect_shared_out(false, 4.0);
}

/* Surfaces keep their light, each its own, whatever the other one has. */
static void test_other_surfaces(void **state)
{
    (void)state;
    fill(true, 4.0f);
    brighten(BRIGHT, 100.0f);
    fireflies_spread(&gbuffer, 0);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (is_right(lane))
            assert_float_equal(tile()->irradiance_r[lane], 1.0, 0.0);
        else if (lane != BRIGHT)
            assert_float_equal(tile()->irradiance_r[lane], 1.0 + 98.0 / 127.0, 1e-4);
    fill(true, 4.0f);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (is_right(lane))
            brighten(lane, 100.0f);
    fireflies_spread(&gbuffer, 0);
    assert_float_equal(sum(tile()->irradiance_r), 128.0 + 12800.0, 1e-2);
    assert_float_equal(tile()->irradiance_r[BRIGHT], 1.0, 0.0);
}

/* So does what is not bright enough, where chance decides and elsewhere, what few others are like,
 * and the bright half of a surface. */
static void test_left_alone(void **state)
{
    (void)state;
    fill(true, 0.0f);
    brighten(BRIGHT, 1.9f);
    fireflies_spread(&gbuffer, 0);
    assert_float_equal(tile()->irradiance_r[BRIGHT], 1.9f, 0.0);
    fill(false, 0.0f);
    brighten(BRIGHT, 3.9f);
    fireflies_spread(&gbuffer, 0);
    assert_float_equal(tile()->irradiance_r[BRIGHT], 3.9f, 0.0);
    fill(true, 0.0f);
    brighten(0, 100.0f);
    for (uint32_t lane = 8; lane < PS_TILE_PIXELS; lane++)
        tile()->object[lane] = 1;
    fireflies_spread(&gbuffer, 0);
    assert_float_equal(tile()->irradiance_r[0], 100.0, 0.0);
    fill(true, 0.0f);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (lane % PS_TILE_SIZE >= 12)
            brighten(lane, 100.0f);
    fireflies_spread(&gbuffer, 0);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        double expected = lane % PS_TILE_SIZE >= 12 ? 100.0 : 1.0;
        assert_float_equal(tile()->irradiance_r[lane], expected, 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shared_out),
        cmocka_unit_test(test_other_surfaces),
        cmocka_unit_test(test_left_alone),
    };
    return cmocka_run_group_tests(tests, open_gbuffer, close_gbuffer);
}
