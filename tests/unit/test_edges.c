/* test_edges.c: which pixels differ from their neighbours. The picture is wider than a tile, and
 * its right half differs from its left one in one thing at a time. */
#include "view/edges.h"

#include "gbuffer_fixture.h"

#define WIDTH 20
#define HEIGHT 18

static int open_gbuffer(void **state)
{
    (void)state;
    return create_gbuffer(WIDTH, HEIGHT);
}

static const ps_hit grey = {.normal = {0, 0, 1}, .albedo = {0.5f, 0.5f, 0.5f}};

/* All see a plane: those from column `first` on the other one, at its place. */
static void fill(uint32_t first, const ps_hit *other, ps_rgb other_direct, ps_rgb other_emitted)
{
    for (uint32_t tile = 0; tile < gbuffer.tile_count; tile++) {
        gbuffer_clear_tile(&gbuffer, tile);
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            bool inside = gbuffer_pixel(&gbuffer, tile, lane, &x, &y), far = x >= first;
            size_t i = (size_t)tile * PS_TILE_PIXELS + lane;
            ps_hit hit = far ? *other : grey;
            hit.position.x = (float)x;
            hit.position.y = (float)y;
            gbuffer.direct[i] = far ? other_direct : (ps_rgb){1, 1, 1};
            gbuffer.emitted[i] = far ? other_emitted : (ps_rgb){0, 0, 0};
            if (inside && hit.object != PS_NO_OBJECT)
                gbuffer_store(&gbuffer.tiles[tile], lane, &hit, (ps_rgb){1, 1, 1}, 1);
        }
    }
}

/* The pixels at both sides of column `first` and no others are edges; 0: there are none. */
static void expect_edge_at(uint32_t first)
{
    for (uint32_t tile = 0; tile < gbuffer.tile_count; tile++) {
        uint8_t edges[PS_TILE_PIXELS];
        edges_find(&gbuffer, tile, edges);
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            bool inside = gbuffer_pixel(&gbuffer, tile, lane, &x, &y);
            bool expected = inside && first > 0 && (x == first || x + 1 == first);
            assert_int_equal(edges[lane], expected);
        }
    }
}

static const ps_rgb one = {1, 1, 1}, none = {0, 0, 0};

static void test_a_plane_has_none(void **state)
{
    (void)state;
    fill(7, &grey, one, none);
    expect_edge_at(0);
    ps_hit sky = grey;
    sky.object = PS_NO_OBJECT;
    fill(0, &sky, one, none); /* nor has nothing */
    expect_edge_at(0);
}

static void test_surfaces_that_differ(void **state)
{
    (void)state;
    ps_hit other = grey;
    other.normal = (ps_vec3){0, 0, -1};
    fill(7, &other, one, none);
    expect_edge_at(7);
    other = grey;
    other.position.z = 1; /* a step */
    fill(7, &other, one, none);
    expect_edge_at(7);
    other = grey;
    other.object = 1;
    fill(7, &other, one, none);
    expect_edge_at(7);
    other.object = PS_NO_OBJECT;
    fill(7, &other, one, none);
    expect_edge_at(7);
}

static void test_edges_between_tiles(void **state)
{
    (void)state;
    ps_hit other = grey;
    other.object = 1;
    fill(PS_TILE_SIZE, &other, one, none);
    expect_edge_at(PS_TILE_SIZE);
}

/* Bent normals make none, as long as they do not turn far. */
static void test_bumps_are_none(void **state)
{
    (void)state;
    ps_hit bent = grey;
    bent.normal = (ps_vec3){0.28f, 0, 0.96f};
    fill(7, &bent, one, none);
    expect_edge_at(0);
    bent.normal = (ps_vec3){0.8f, 0, 0.6f};
    fill(19, &bent, one, none);
    expect_edge_at(19);
}

/* What a pixel shows by chance says nothing of what it might show. */
static void test_pixels_that_show_something_by_chance(void **state)
{
    (void)state;
    uint8_t edges[PS_TILE_PIXELS];
    fill(7, &grey, one, none);
    gbuffer.choice[5] = CHOSEN_BY_LENS_OR_GLOSS;
    edges_find(&gbuffer, 0, edges);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        assert_int_equal(edges[lane], lane == 5);
}

/* The pixels around such a pixel take as many samples as it does, if they are edges. */
static void test_pixels_that_see_glass(void **state)
{
    (void)state;
    uint8_t edges[PS_TILE_PIXELS];
    fill(7, &grey, (ps_rgb){2, 2, 2}, none);
    gbuffer.choice[6] = CHOSEN_BY_GLASS;
    gbuffer.choice[4 * PS_TILE_SIZE + 3] = CHOSEN_BY_GLASS;
    edges_find(&gbuffer, 0, edges);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x = lane % PS_TILE_SIZE;
        bool sees_glass = lane == 6 || lane == 4 * PS_TILE_SIZE + 3;
        bool is_beside = lane == 7 || lane == PS_TILE_SIZE + 6;
        bool is_edge = x == 6 || x == 7;
        assert_int_equal(edges[lane], sees_glass || is_beside ? GLASS_EDGE
                                      : is_edge               ? EDGE
                                                              : NO_EDGE);
    }
}

/* By more than a quarter of the larger one. */
static void test_light_and_albedo_that_differ(void **state)
{
    (void)state;
    fill(7, &grey, (ps_rgb){1, 0.7f, 1}, none);
    expect_edge_at(7);
    fill(7, &grey, (ps_rgb){1, 0.8f, 1}, none);
    expect_edge_at(0);
    fill(7, &grey, one, (ps_rgb){0, 0, 0.1f}); /* beside 0.5 / pi reflected */
    expect_edge_at(7);
    ps_hit other = grey;
    other.albedo.r = 0.35f;
    fill(7, &other, none, none); /* in the dark indirect light may show it */
    expect_edge_at(7);
    other.albedo.r = 0.4f;
    fill(7, &other, one, none);
    expect_edge_at(0);
}

/* Half of the shadow rays find `near` left of column 7, `far` from there on. */
static void set_halves(ps_rgb near, ps_rgb far)
{
    for (uint32_t tile = 0; tile < gbuffer.tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x = 0, y;
            gbuffer_pixel(&gbuffer, tile, lane, &x, &y);
            gbuffer.direct_half[(size_t)tile * PS_TILE_PIXELS + lane] = x >= 7 ? far : near;
        }
}

/* Light that differs by no more than its shadow rays' noise is no edge; where halves agree, it
 * is. */
static void test_noise_is_none(void **state)
{
    (void)state;
    struct error error;
    assert_int_equal(gbuffer_prepare_direct_half(&gbuffer, &error), PS_OK);
    fill(7, &grey, none, none);
    set_halves(one, none);
    expect_edge_at(7);
    set_halves((ps_rgb){1.5f, 1.5f, 1.5f}, none);
    expect_edge_at(0);
    fill(7, &grey, (ps_rgb){20, 20, 20}, none);
    expect_edge_at(0); /* halves of 20 and 0 */
    set_halves((ps_rgb){1.5f, 1.5f, 1.5f}, (ps_rgb){20, 20, 20});
    expect_edge_at(7);
    ps_hit other = grey;
    other.object = 3;
    fill(7, &other, one, none);
    set_halves(none, none);
    expect_edge_at(7); /* surfaces differ all the same */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_plane_has_none),
        cmocka_unit_test(test_surfaces_that_differ),
        cmocka_unit_test(test_edges_between_tiles),
        cmocka_unit_test(test_bumps_are_none),
        cmocka_unit_test(test_pixels_that_show_something_by_chance),
        cmocka_unit_test(test_pixels_that_see_glass),
        cmocka_unit_test(test_light_and_albedo_that_differ),
        cmocka_unit_test(test_noise_is_none), /* last: the G-buffer has halves from here on */
    };
    return cmocka_run_group_tests(tests, open_gbuffer, close_gbuffer);
}
