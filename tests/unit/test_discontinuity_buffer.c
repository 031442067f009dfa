/* test_discontinuity_buffer.c: which pixels join their direct light: on synthetic G-buffers, wider
 * than a tile. */
#include "direct/discontinuity_buffer.h"
#include "gbuffer_fixture.h"
#include "support/workers.h"

#include <math.h>

#define WIDTH 20
#define HEIGHT 18

static int open_gbuffer(void **state)
{
    (void)state;
    struct error error;
    return create_gbuffer(WIDTH, HEIGHT) != 0 ||
           gbuffer_prepare_discontinuity_buffer(&gbuffer, &error) != PS_OK;
}

/* What a pixel shows. */
struct view {
    ps_vec3 normal;
    float height; /* above the plane z = 0 */
    float direct;
    uint64_t met;
};

static size_t index_of(uint32_t x, uint32_t y)
{
    uint32_t lane, tile = gbuffer_tile_of(&gbuffer, x, y, &lane);
    return (size_t)tile * PS_TILE_PIXELS + lane;
}

static void join(struct view (*at)(uint32_t x, uint32_t y))
{
    for (uint32_t tile = 0; tile < gbuffer.tile_count; tile++)
        gbuffer_clear_tile(&gbuffer, tile);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            struct view sight = at(x, y);
            ps_hit hit = {
                .position = {(float)x, (float)y, sight.height},
                .normal = sight.normal,
            };
            size_t i = index_of(x, y);
            gbuffer_store(&gbuffer.tiles[i / PS_TILE_PIXELS], (uint32_t)(i % PS_TILE_PIXELS), &hit,
                          (ps_rgb){1, 1, 1}, 1);
            gbuffer.direct[i] = (ps_rgb){sight.direct, 2 * sight.direct, 0};
            gbuffer.occlusion[i] = sight.met;
        }
    struct workers *workers = start_workers(3);
    discontinuity_buffer(&gbuffer, workers);
    workers_destroy(workers);
}

static float joined(uint32_t x, uint32_t y)
{
    ps_rgb direct = gbuffer.direct[index_of(x, y)];
    assert_float_equal(direct.g, 2 * direct.r, 1e-5);
    return direct.r;
}

static const ps_vec3 up = {0, 0, 1};

/* --- what rays met
 * ------------------------------------------------------------------------------ */

static void test_lights_are_seen_alike(void **state)
{
    (void)state;
    uint64_t whole = gbuffer_occlusion(3, 1.0f), none = gbuffer_occlusion(3, 0.0f),
             part = whole | none;
    assert_true(gbuffer_occlusion_alike(0, 0));
    assert_true(gbuffer_occlusion_alike(whole, whole) && gbuffer_occlusion_alike(none, none));
    assert_true(gbuffer_occlusion_alike(part, whole) && gbuffer_occlusion_alike(none, part));
    assert_int_equal(gbuffer_occlusion(3, 0.5f), part);
    assert_false(gbuffer_occlusion_alike(whole, none));
    assert_false(gbuffer_occlusion_alike(whole, 0)); /* out of its reach */
    /* One light that differs is enough; light 35 has the bits of light 3. */
    uint64_t other = gbuffer_occlusion(31, 1.0f);
    assert_true(gbuffer_occlusion_alike(other | part, other | whole));
    assert_false(gbuffer_occlusion_alike(other | whole, other | none));
    assert_int_equal(gbuffer_occlusion(35, 1.0f), whole);
}

/* --- a flat surface
 * ------------------------------------------------------------------------------- */

#define HALF_LIT (gbuffer_occlusion(0, 1.0f) | gbuffer_occlusion(0, 0.0f))

static struct view one_bright_pixel(uint32_t x, uint32_t y)
{
    return (struct view){up, 0, x == 8 && y == 9 ? 25.0f : 0.0f, HALF_LIT};
}

static void test_a_window_of_5_by_5(void **state)
{
    (void)state;
    join(one_bright_pixel);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            bool within = x >= 6 && x <= 10 && y >= 7 && y <= 11;
            assert_float_equal(joined(x, y), within ? 1.0 : 0.0, 1e-5);
        }
}

static struct view ramp(uint32_t x, uint32_t y)
{
    return (struct view){up, 0, 3.0f * (float)x + (float)y, HALF_LIT};
}

/* Up to the picture's borders, where half of the window is missing. */
static void test_what_falls_off_evenly_stays(void **state)
{
    (void)state;
    join(ramp);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++)
            assert_float_equal(joined(x, y), 3.0f * (float)x + (float)y, 1e-4);
}

/* --- what nothing crosses
 * ----------------------------------------------------------------------- */

static struct view hard_shadow(uint32_t x, uint32_t y)
{
    (void)y;
    return (struct view){up, 0, x < 9 ? 1.0f : 0.0f, gbuffer_occlusion(0, x < 9 ? 1.0f : 0.0f)};
}

static struct view cone(uint32_t x, uint32_t y)
{
    (void)y;
    return (struct view){up, 0, x < 9 ? 1.0f : 0.0f, x < 9 ? gbuffer_occlusion(0, 1.0f) : 0};
}

static struct view step(uint32_t x, uint32_t y)
{
    (void)y;
    return (struct view){up, x < 9 ? 4.0f : 0.0f, x < 9 ? 1.0f : 0.0f, HALF_LIT};
}

static struct view roof(uint32_t x, uint32_t y)
{
    (void)y;
    ps_vec3 left = {-0.1f, 0, 0.995f}, right = {0.1f, 0, 0.995f};
    return (struct view){x < 9 ? left : right, 0, x < 9 ? 1.0f : 0.0f, HALF_LIT};
}

static void test_edges_stay_sharp(void **state)
{
    (void)state;
    struct view (*const sights[])(uint32_t x, uint32_t y) = {hard_shadow, cone, step, roof};
    for (size_t i = 0; i < sizeof sights / sizeof sights[0]; i++) {
        join(sights[i]);
        for (uint32_t x = 0; x < WIDTH; x++)
            assert_float_equal(joined(x, 9), x < 9 ? 1.0 : 0.0, 1e-6);
    }
}

/* --- numbers
 * ------------------------------------------------------------------------------------ */

static uint64_t first_number(uint32_t x, uint32_t y, uint32_t pass)
{
    uint32_t lane, tile = gbuffer_tile_of(&gbuffer, x, y, &lane);
    struct light_runs runs;
    discontinuity_buffer_runs(&gbuffer, tile, pass, 4, &runs);
    assert_true(runs.of_lane[lane] < runs.count);
    return runs.first[runs.of_lane[lane]];
}

/* Any 5x5 pixels, also of several tiles, have all numbers of a pass, each once; the next pass goes
 * on. */
static void test_a_window_shares_a_run(void **state)
{
    (void)state;
    for (uint32_t pass = 0; pass < 2; pass++)
        for (uint32_t top = 9; top <= HEIGHT - 5; top += 2)
            for (uint32_t left = 0; left <= WIDTH - 5; left++) {
                uint32_t seen = 0;
                for (uint32_t i = 0; i < 25; i++) {
                    uint64_t first = first_number(left + i % 5, top + i / 5, pass);
                    assert_true(first % 4 == 0 && first / 4 / 25 == pass);
                    seen |= 1u << first / 4 % 25;
                }
                assert_int_equal(seen, (1u << 25) - 1);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lights_are_seen_alike),
        cmocka_unit_test(test_a_window_of_5_by_5),
        cmocka_unit_test(test_what_falls_off_evenly_stays),
        cmocka_unit_test(test_edges_stay_sharp),
        cmocka_unit_test(test_a_window_shares_a_run),
    };
    return cmocka_run_group_tests(tests, open_gbuffer, close_gbuffer);
}
