/* test_film.c: sums and means over passes, pixels seen in some passes or none, and the tiles. */
#include "film/film_sum.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 20
#define HEIGHT 18
#define PI 3.14159265358979323846

struct bench {
    struct gbuffer gbuffer;
    struct film film;    /* a pass, and then the sum of those so far */
    struct film_sum sum; /* made with the first pass */
};

static struct bench bench;

static int open_bench(void **state)
{
    (void)state;
    struct error error;
    assert_int_equal(gbuffer_create(gbuffer_layout(WIDTH, HEIGHT), &bench.gbuffer, &error), PS_OK);
    assert_int_equal(film_create(WIDTH, HEIGHT, true, &bench.film, &error), PS_OK);
    return 0;
}

static int close_bench(void **state)
{
    (void)state;
    film_sum_release(&bench.sum);
    film_release(&bench.film);
    gbuffer_release(&bench.gbuffer);
    return 0;
}

/* A lane that sees an object, everything in it a multiple of `value`. */
static void see(ps_tile *tile, ps_rgb *direct, uint32_t lane, float value)
{
    tile->object[lane] = tile->material[lane] = 0;
    tile->albedo_r[lane] = 1; /* times the throughput: 0.5, 0.25, 1 */
    tile->albedo_g[lane] = 0.0625f;
    tile->albedo_b[lane] = 0.5f;
    tile->throughput_r[lane] = 0.5f;
    tile->throughput_g[lane] = 4;
    tile->throughput_b[lane] = 2;
    tile->normal_x[lane] = 1;
    tile->position_x[lane] = value;
    tile->position_y[lane] = 2 * value;
    tile->position_z[lane] = 3 * value;
    tile->depth[lane] = 4 * value;
    tile->irradiance_r[lane] = value;
    tile->irradiance_g[lane] = 2 * value;
    tile->irradiance_b[lane] = 3 * value;
    tile->weight[lane] = 10 * value;
    *direct = (ps_rgb){5 * value, 6 * value, 7 * value};
}

static void see_nothing(ps_tile *tile, uint32_t lane)
{
    tile->object[lane] = tile->material[lane] = PS_NO_OBJECT;
    tile->position_x[lane] = tile->position_y[lane] = tile->position_z[lane] = 1e18f;
    tile->depth[lane] = INFINITY;
    tile->irradiance_r[lane] = tile->weight[lane] = 77; /* must not be taken */
}

static float pixel_value(uint32_t x, uint32_t y)
{
    return (float)(1 + x + 100 * y);
}

/* One more pass: pixels from column `first` on see something, `factor` times their own value. */
static void add_pass(uint32_t first, float factor)
{
    struct error error;
    uint32_t number = pass_set_size(&bench.sum.passes);
    assert_int_equal(film_begin_pass(&bench.film, number, &error), PS_OK);
    for (uint32_t tile = 0; tile < bench.gbuffer.tile_count; tile++) {
        gbuffer_clear_tile(&bench.gbuffer, tile);
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            ps_rgb *direct = &bench.gbuffer.direct[tile * PS_TILE_PIXELS + lane];
            *direct = (ps_rgb){0, 0, 0};
            gbuffer_pixel(&bench.gbuffer, tile, lane, &x, &y);
            if (x >= first) /* lanes outside of the picture too: nothing may come of them */
                see(&bench.gbuffer.tiles[tile], direct, lane, factor * pixel_value(x, y));
            else
                see_nothing(&bench.gbuffer.tiles[tile], lane);
        }
        film_add_tile(&bench.film, &bench.gbuffer, tile, NULL);
    }
    film_end_pass(&bench.film);
    if (number == 0)
        assert_int_equal(film_sum_create(&bench.film, &bench.sum, &error), PS_OK);
    assert_int_equal(film_sum_add(&bench.sum, &bench.film, NULL, &error), PS_OK);
    film_sum_round(&bench.sum, &bench.film, NULL);
}

static void expect_in(const struct film *film, enum film_plane plane, uint32_t x, uint32_t y,
                      double expected)
{
    double value = film->planes[plane][y * WIDTH + x];
    if (fabs(value - expected) > 1e-5 * fabs(expected))
        fail_msg("plane %d at (%u, %u): %.8g, expected %.8g", (int)plane, x, y, value, expected);
}

static void expect(enum film_plane plane, uint32_t x, uint32_t y, double expected)
{
    expect_in(&bench.film, plane, x, y, expected);
}

/* A pixel that is left out gets what its samples hold instead, by their shares. */
static void test_samples_take_the_place_of_a_lane(void **state)
{
    (void)state;
    uint8_t left_out[PS_TILE_PIXELS] = {false};
    left_out[1] = true;
    gbuffer_clear_tile(&bench.gbuffer, 0);
    for (uint32_t lane = 0; lane < 3; lane++) {
        bench.gbuffer.emitted[lane] = (ps_rgb){1, 1, 1};
        see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[lane], lane, 1);
    }
    film_add_tile(&bench.film, &bench.gbuffer, 0, left_out);
    expect(FILM_DIRECT_R, 0, 0, 1 + 5 * 0.5 / PI);
    expect(FILM_DIRECT_R, 1, 0, 0);
    expect(FILM_COVERAGE, 1, 0, 0);
    see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[2], 2, 9);
    film_add_samples(&bench.film, &bench.gbuffer, 0, 1, 0.75f, 1, 0);
    film_add_samples(&bench.film, &bench.gbuffer, 2, 1, 0.25f, 1, 0);
    expect(FILM_DIRECT_R, 1, 0, 1 + 5 * 0.5 / PI * (0.75 + 0.25 * 9));
    expect(FILM_COLOR_G, 1, 0, 2 * 0.25 / PI * (0.75 + 0.25 * 9));
    expect(FILM_POSITION_X, 1, 0, 0.75 + 0.25 * 9);
    expect(FILM_COVERAGE, 1, 0, 1);
    expect(FILM_COVERAGE, 0, 0, 1);
}

/* More samples than a row of a tile has. */
static void test_many_samples_of_a_pixel(void **state)
{
    (void)state;
    enum { MANY = 2 * PS_TILE_SIZE + 5 };
    gbuffer_clear_tile(&bench.gbuffer, 0);
    for (uint32_t lane = 0; lane < MANY + 3; lane++)
        see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[lane], lane, (float)lane);
    film_add_samples(&bench.film, &bench.gbuffer, 3, MANY, 1.0f / MANY, 1, 1);
    expect(FILM_POSITION_X, 1, 1, 3 + (MANY - 1) / 2.0);
    expect(FILM_COVERAGE, 1, 1, 1);
    expect(FILM_COVERAGE, 0, 1, 0);
}

/* What is emitted joins the direct light, also where no surface is seen. */
static void test_emission_is_added(void **state)
{
    (void)state;
    gbuffer_clear_tile(&bench.gbuffer, 0);
    bench.gbuffer.emitted[0] = (ps_rgb){1, 2, 3};
    bench.gbuffer.emitted[1] = (ps_rgb){4, 5, 6};
    bench.gbuffer.direct[0] = bench.gbuffer.direct[1] = (ps_rgb){0, 0, 0};
    see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[1], 1, 1);
    film_add_tile(&bench.film, &bench.gbuffer, 0, NULL);
    expect(FILM_DIRECT_B, 0, 0, 3);
    expect(FILM_COVERAGE, 0, 0, 0);
    expect(FILM_DIRECT_R, 1, 0, 4 + 5 * 0.5 / PI);
    expect(FILM_COVERAGE, 1, 0, 1);
}

static void test_lanes_are_pixels(void **state)
{
    (void)state;
    uint32_t seen[WIDTH * HEIGHT] = {0}, inside = 0;
    assert_int_equal(bench.gbuffer.tile_count, 4);
    for (uint32_t tile = 0; tile < 4; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            if (!gbuffer_pixel(&bench.gbuffer, tile, lane, &x, &y))
                continue;
            inside++;
            assert_int_equal(seen[y * WIDTH + x]++, 0);
            assert_int_equal(x / PS_TILE_SIZE + 2 * (y / PS_TILE_SIZE), tile);
        }
    assert_int_equal(inside, WIDTH * HEIGHT);
    assert_int_equal((uintptr_t)bench.gbuffer.tiles % 64, 0);
}

static void test_new_film_is_empty(void **state)
{
    (void)state;
    for (int plane = 0; plane < FILM_ON_REQUEST; plane++)
        for (size_t i = 0; i < WIDTH * HEIGHT; i++)
            assert_true(bench.film.planes[plane][i] == 0);
    assert_int_equal(bench.film.passes, 0);
    film_average(&bench.film); /* no passes: nothing seen, nothing divided by 0 */
    for (int plane = 0; plane < FILM_ON_REQUEST; plane++)
        assert_true(plane == FILM_DEPTH ? isinf(bench.film.planes[plane][5])
                                        : bench.film.planes[plane][5] == 0);
}

static void test_passes_add_up(void **state)
{
    (void)state;
    add_pass(0, 1);
    add_pass(0, 2);
    assert_int_equal(bench.film.passes, 2);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double v = 3 * pixel_value(x, y);
            expect(FILM_DIRECT_R, x, y, 0.5 / PI * 5 * v);
            expect(FILM_DIRECT_G, x, y, 0.25 / PI * 6 * v);
            expect(FILM_DIRECT_B, x, y, 1 / PI * 7 * v);
            expect(FILM_COLOR_R, x, y, 0.5 / PI * v);
            expect(FILM_COLOR_G, x, y, 0.25 / PI * 2 * v);
            expect(FILM_COLOR_B, x, y, 1 / PI * 3 * v);
            expect(FILM_WEIGHT, x, y, 10 * v);
            expect(FILM_ALBEDO_G, x, y, 0.5);
            expect(FILM_POSITION_Z, x, y, 3 * v);
            expect(FILM_DEPTH, x, y, 4 * v);
            expect(FILM_COVERAGE, x, y, 2);
        }
}

/* The mean: geometry and direct light; colour and weight stay sums, for the normalization. */
static void test_average(void **state)
{
    (void)state;
    add_pass(0, 1);
    add_pass(0, 2);
    film_average(&bench.film);
    double v = pixel_value(17, 3);
    expect(FILM_DIRECT_R, 17, 3, 0.5 / PI * 5 * 1.5 * v);
    expect(FILM_DIRECT_B, 17, 3, 1 / PI * 7 * 1.5 * v);
    expect(FILM_ALBEDO_R, 17, 3, 0.5);
    expect(FILM_ALBEDO_B, 17, 3, 1);
    expect(FILM_NORMAL_X, 17, 3, 1);
    expect(FILM_POSITION_Y, 17, 3, 2 * 1.5 * v);
    expect(FILM_DEPTH, 17, 3, 4 * 1.5 * v);
    expect(FILM_COLOR_G, 17, 3, 0.25 / PI * 2 * 3 * v);
    expect(FILM_WEIGHT, 17, 3, 10 * 3 * v);
}

/* Seen in one pass of two: half of the light, all of the geometry. */
static void test_partly_covered_pixels(void **state)
{
    (void)state;
    add_pass(0, 1);
    add_pass(10, 1);
    film_average(&bench.film);
    double v = pixel_value(4, 2);
    expect(FILM_COVERAGE, 4, 2, 1);
    expect(FILM_DIRECT_G, 4, 2, 0.25 / PI * 6 * v / 2);
    expect(FILM_COLOR_G, 4, 2, 0.25 / PI * 2 * v);
    expect(FILM_ALBEDO_G, 4, 2, 0.25);
    expect(FILM_POSITION_X, 4, 2, v);
    expect(FILM_DEPTH, 4, 2, 4 * v);
    expect(FILM_WEIGHT, 4, 2, 10 * v);
    expect(FILM_DIRECT_G, 12, 2, 0.25 / PI * 6 * pixel_value(12, 2));
}

static void test_uncovered_pixels(void **state)
{
    (void)state;
    add_pass(10, 1);
    add_pass(10, 2);
    film_average(&bench.film);
    for (int plane = 0; plane < FILM_ON_REQUEST; plane++)
        if (plane != FILM_DEPTH)
            expect((enum film_plane)plane, 9, 17, 0);
    assert_true(isinf(bench.film.planes[FILM_DEPTH][17 * WIDTH + 9]));
    assert_true(isfinite(bench.film.planes[FILM_DEPTH][17 * WIDTH + 10]));
}

/* The light is the same, and the surfaces are not there. */
static void test_film_of_light_alone(void **state)
{
    (void)state;
    struct error error;
    add_pass(10, 1);
    film_average(&bench.film);
    struct film whole = bench.film;
    film_sum_release(&bench.sum);
    assert_int_equal(film_create(WIDTH, HEIGHT, false, &bench.film, &error), PS_OK);
    add_pass(10, 1);
    film_average(&bench.film);
    for (int plane = 0; plane < FILM_ON_REQUEST; plane++) {
        bool of_surfaces = plane >= FILM_ALBEDO_R && plane <= FILM_VISIBLE;
        assert_true((bench.film.planes[plane] == NULL) == of_surfaces);
        if (!of_surfaces)
            assert_memory_equal(bench.film.planes[plane], whole.planes[plane],
                                WIDTH * HEIGHT * sizeof(float));
    }
    assert_true(film_bytes(&bench.film) < film_bytes(&whole));
    assert_int_equal(film_bytes(&whole), WIDTH * HEIGHT * sizeof(float) * FILM_ON_REQUEST);
    film_release(&whole);
}

static void keep_reflected(bool half_of_pass, bool hard_apart)
{
    struct error error;
    assert_int_equal(film_add_reflected(&bench.film, hard_apart, &error), PS_OK);
    assert_int_equal(film_add_half_of_reflected(&bench.film, half_of_pass, &error), PS_OK);
}

/* Without what is emitted; and in `odd` the second pass. */
static void test_reflected_light_apart(void **state)
{
    (void)state;
    keep_reflected(false, false);
    add_pass(0, 1);
    add_pass(0, 3);
    film_average(&bench.film);
    double reflected = 0.25 / PI * 6 * pixel_value(12, 2);
    expect(FILM_REFLECTED_G, 12, 2, 2 * reflected);
    expect_in(bench.film.odd, FILM_REFLECTED_G, 12, 2, 3 * reflected);
    assert_null(bench.film.odd->planes[FILM_COLOR_R]);
}

/* In `half` is what half of each pass's shadow rays found. */
static void test_half_of_a_pass(void **state)
{
    (void)state;
    struct error error;
    keep_reflected(true, false);
    assert_int_equal(gbuffer_prepare_direct_half(&bench.gbuffer, &error), PS_OK);
    for (size_t i = 0; i < (size_t)bench.gbuffer.tile_count * PS_TILE_PIXELS; i++)
        bench.gbuffer.direct_half[i] = (ps_rgb){1, 2, 3};
    add_pass(0, 1);
    add_pass(0, 3);
    assert_int_equal(bench.film.half->passes, 2);
    assert_null(bench.film.odd);
    film_average(&bench.film);
    expect(FILM_REFLECTED_G, 12, 2, 2 * 0.25 / PI * 6 * pixel_value(12, 2));
    expect_in(bench.film.half, FILM_REFLECTED_G, 12, 2, 0.25 / PI * 2);
}

/* What comes from lights that cast hard shadows is kept apart from the rest, and in halves
 * likewise. */
static void test_hard_light_apart(void **state)
{
    (void)state;
    struct error error;
    keep_reflected(true, true);
    assert_int_equal(gbuffer_prepare_direct_half(&bench.gbuffer, &error), PS_OK);
    assert_int_equal(gbuffer_prepare_hard(&bench.gbuffer, &error), PS_OK);
    for (size_t i = 0; i < (size_t)bench.gbuffer.tile_count * PS_TILE_PIXELS; i++) {
        bench.gbuffer.direct_half[i] = (ps_rgb){1, 2, 3};
        bench.gbuffer.hard_half[i] = (ps_rgb){0.25f, 0.5f, 0.75f};
        bench.gbuffer.hard[i] = (ps_rgb){0.125f, 0.25f, 0.5f};
    }
    add_pass(0, 1);
    film_average(&bench.film);
    double reflectance = 0.25 / PI, direct = 6 * pixel_value(12, 2);
    expect(FILM_HARD_G, 12, 2, reflectance * 0.25);
    expect(FILM_REFLECTED_G, 12, 2, reflectance * (direct - 0.25));
    expect(FILM_DIRECT_G, 12, 2, reflectance * direct);
    expect_in(bench.film.half, FILM_HARD_G, 12, 2, reflectance * 0.5);
    expect_in(bench.film.half, FILM_REFLECTED_G, 12, 2, reflectance * 1.5);
}

/* A lane whose path met gloss, of depth 8 and reflectance 1/2, with value 2 in all that it is. */
static void meet_gloss(uint32_t lane)
{
    ps_hit hit = {.position = {2, 2, 2}, .normal = {0, 1, 0}};
    gbuffer_store_glossy(&bench.gbuffer.glossy[0], lane, &hit, (ps_rgb){0.5f, 0.5f, 0.5f}, 0.75f,
                         8);
    hit.position.x = 99; /* a second one does not count */
    gbuffer_store_glossy(&bench.gbuffer.glossy[0], lane, &hit, (ps_rgb){1, 1, 1}, 0, 99);
    bench.gbuffer.emitted[lane] = (ps_rgb){3, 3, 3};
}

/* The first glossy surface stands for what lies behind, and for nothing behind; light is what it
 * is. */
static void test_first_glossy_surface(void **state)
{
    (void)state;
    struct error error;
    assert_int_equal(gbuffer_prepare_glossy(&bench.gbuffer, &error), PS_OK);
    keep_reflected(true, false);
    assert_int_equal(film_add_plane(&bench.film, FILM_GLOSS, &error), PS_OK);
    gbuffer_clear_tile(&bench.gbuffer, 0);
    for (uint32_t lane = 0; lane < 2; lane++)
        see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[lane], lane, 1);
    see_nothing(&bench.gbuffer.tiles[0], 2);
    meet_gloss(1);
    meet_gloss(2);
    film_add_tile(&bench.film, &bench.gbuffer, 0, NULL);
    film_end_pass(&bench.film);
    film_average(&bench.film);
    double reflected = 0.5 / PI * 5;
    expect(FILM_POSITION_X, 0, 0, 1);
    expect(FILM_REFLECTED_R, 0, 0, reflected);
    expect(FILM_GLOSS, 0, 0, 0);
    for (uint32_t x = 1; x <= 2; x++) {
        expect(FILM_POSITION_X, x, 0, 2);
        expect(FILM_NORMAL_Y, x, 0, 1);
        expect(FILM_ALBEDO_G, x, 0, 0.5);
        expect(FILM_DEPTH, x, 0, 8);
        expect(FILM_GLOSS, x, 0, 0.75);
        expect(FILM_COVERAGE, x, 0, x == 1);
        expect(FILM_COLOR_R, x, 0, x == 1 ? 0.5 / PI : 0);
        expect(FILM_REFLECTED_R, x, 0, 3 + (x == 1 ? reflected : 0));
        expect(FILM_DIRECT_R, x, 0, 3 + (x == 1 ? reflected : 0));
    }
    gbuffer_clear_tile(&bench.gbuffer, 0);
    assert_true(bench.gbuffer.glossy[0].depth[1] == 0);
}

/* The variance is that of the irradiance of what is seen: not where gloss stands for the pixel, nor
 * where its own sample is left out. */
static void test_variance(void **state)
{
    (void)state;
    struct error error;
    static const uint8_t left_out[PS_TILE_PIXELS] = {[3] = true};
    assert_int_equal(gbuffer_prepare_glossy(&bench.gbuffer, &error), PS_OK);
    assert_int_equal(film_add_plane(&bench.film, FILM_VARIANCE, &error), PS_OK);
    gbuffer_clear_tile(&bench.gbuffer, 0);
    for (uint32_t lane = 0; lane < 4; lane++) {
        see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[lane], lane, 1);
        bench.gbuffer.tiles[0].variance[lane] = 9;
    }
    see_nothing(&bench.gbuffer.tiles[0], 1);
    meet_gloss(2);
    film_add_tile(&bench.film, &bench.gbuffer, 0, left_out);
    for (uint32_t x = 0; x < 4; x++)
        expect(FILM_VARIANCE, x, 0, x == 0 ? 9 : 0);
    gbuffer_clear_indirect(&bench.gbuffer);
    assert_true(bench.gbuffer.tiles[0].variance[0] == 0);
}

/* A lane whose path met a mirror and then nothing, with value 3 in all that it is. */
static void meet_mirror(uint32_t lane)
{
    ps_hit hit = {.position = {3, 3, 3}, .normal = {0, 0, 1}};
    gbuffer_store_mirror(&bench.gbuffer.glossy[0], lane, &hit, (ps_rgb){0.75f, 2, 1}, 12);
    bench.gbuffer.emitted[lane] = (ps_rgb){3, 3, 3};
}

/* A mirror stands for a pixel that sees nothing else, and its light is none to smooth. */
static void test_mirror_with_nothing_behind(void **state)
{
    (void)state;
    struct error error;
    assert_int_equal(gbuffer_prepare_glossy(&bench.gbuffer, &error), PS_OK);
    keep_reflected(true, false);
    assert_int_equal(film_add_plane(&bench.film, FILM_GLOSS, &error), PS_OK);
    gbuffer_clear_tile(&bench.gbuffer, 0);
    for (uint32_t lane = 0; lane < 4; lane++)
        see_nothing(&bench.gbuffer.tiles[0], lane);
    meet_mirror(0);
    meet_mirror(1);
    see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[1], 1, 1);
    gbuffer_forget_mirror(&bench.gbuffer.glossy[0], 1);
    meet_mirror(2);
    meet_gloss(2); /* behind the mirror */
    meet_gloss(3);
    meet_mirror(3); /* behind the gloss */
    film_add_tile(&bench.film, &bench.gbuffer, 0, NULL);
    film_end_pass(&bench.film);
    film_average(&bench.film);
    expect(FILM_POSITION_X, 0, 0, 3);
    expect(FILM_NORMAL_Z, 0, 0, 1);
    expect(FILM_DEPTH, 0, 0, 12);
    expect(FILM_ALBEDO_R, 0, 0, 0.75);
    expect(FILM_ALBEDO_G, 0, 0, 1); /* no reflectance is more */
    expect(FILM_GLOSS, 0, 0, 0);
    expect(FILM_COVERAGE, 0, 0, 0);
    expect(FILM_DIRECT_R, 0, 0, 3);
    expect(FILM_REFLECTED_R, 0, 0, 0);
    expect(FILM_POSITION_X, 1, 0, 1);
    expect(FILM_POSITION_X, 2, 0, 2);
    expect(FILM_GLOSS, 2, 0, 0.75);
    expect(FILM_POSITION_X, 3, 0, 2);
}

/* What other samples see counts, and the mirror then does not. */
static void test_mirror_beside_a_surface(void **state)
{
    (void)state;
    struct error error;
    assert_int_equal(gbuffer_prepare_glossy(&bench.gbuffer, &error), PS_OK);
    gbuffer_clear_tile(&bench.gbuffer, 0);
    for (uint32_t lane = 0; lane < 4; lane++)
        see_nothing(&bench.gbuffer.tiles[0], lane);
    meet_mirror(0);
    meet_mirror(1);
    see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[2], 2, 1);
    film_add_samples(&bench.film, &bench.gbuffer, 0, 4, 0.25f, 2, 0);
    film_end_pass(&bench.film);
    film_average(&bench.film);
    expect(FILM_POSITION_X, 2, 0, 1);
    expect(FILM_DEPTH, 2, 0, 4);
    expect(FILM_VISIBLE, 2, 0, 0.25);
}

/* Glass that lets light through by chance makes up for it. */
static void test_albedo_is_no_more_than_1(void **state)
{
    (void)state;
    gbuffer_clear_tile(&bench.gbuffer, 0);
    see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[0], 0, 1);
    bench.gbuffer.tiles[0].throughput_r[0] = 1.25f;
    film_add_tile(&bench.film, &bench.gbuffer, 0, NULL);
    film_end_pass(&bench.film);
    film_average(&bench.film);
    expect(FILM_ALBEDO_R, 0, 0, 1);
    expect(FILM_ALBEDO_G, 0, 0, 0.25);
    expect(FILM_DIRECT_R, 0, 0, 1.25 / PI * 5);
}

/* Of a pixel's samples the second half is in `half` if all met gloss; else half of the shadow
 * rays. */
static void test_halves_of_glossy_samples(void **state)
{
    (void)state;
    struct error error;
    double mean = 0.5 / PI * 5 * (1 + 2 + 3 + 4 + 5) / 5 + 3;
    assert_int_equal(gbuffer_prepare_glossy(&bench.gbuffer, &error), PS_OK);
    assert_int_equal(gbuffer_prepare_direct_half(&bench.gbuffer, &error), PS_OK);
    keep_reflected(true, false);
    gbuffer_clear_tile(&bench.gbuffer, 0);
    for (uint32_t lane = 0; lane < 5; lane++)
        see(&bench.gbuffer.tiles[0], &bench.gbuffer.direct[lane], lane, (float)(1 + lane));
    for (uint32_t lane = 1; lane < 5; lane++)
        meet_gloss(lane);
    film_add_samples(&bench.film, &bench.gbuffer, 0, 5, 0.2f, 2, 0);
    expect_in(bench.film.half, FILM_REFLECTED_R, 2, 0, 3.0 * 4 / 5); /* no shadow rays lit */
    meet_gloss(0);
    film_add_samples(&bench.film, &bench.gbuffer, 0, 5, 0.2f, 1, 0);
    expect(FILM_REFLECTED_R, 1, 0, mean);
    expect_in(bench.film.half, FILM_REFLECTED_R, 1, 0, 0.5 / PI * 5 * (3 + 4 + 5) / 3 + 3);
}

static void test_clear_indirect(void **state)
{
    (void)state;
    add_pass(0, 1);
    gbuffer_clear_indirect(&bench.gbuffer);
    for (uint32_t tile = 0; tile < 4; tile++)
        for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
            const ps_tile *it = &bench.gbuffer.tiles[tile];
            assert_true(it->irradiance_r[i] == 0 && it->irradiance_g[i] == 0 &&
                        it->irradiance_b[i] == 0 && it->weight[i] == 0);
            assert_true(it->albedo_b[i] == 0.5f && it->depth[i] > 0); /* the rest stays */
        }
}

#define FILM_TEST(function) cmocka_unit_test_setup_teardown(function, open_bench, close_bench)

/* A picture of 20 x 12 tiles, the last ones cut, and a part of it that no border of tiles
 * bounds. */
static const struct rectangle part = {101, 70, 30, 21};

static void test_window_of_a_part(void **state)
{
    (void)state;
    struct gbuffer whole = gbuffer_layout(311, 190);
    struct gbuffer window = gbuffer_layout_around(part, true, 311, 190);
    struct rectangle pixels = gbuffer_window(&window);
    assert_true(window.tile_count < gbuffer_picture_tiles(&window) / 2);
    assert_int_equal(gbuffer_picture_tiles(&window), whole.tile_count);
    /* samples at edges, means, and what those are made of: 2, 4 and 4 pixels */
    assert_true(pixels.x <= part.x - 10 && pixels.x + pixels.width >= part.x + part.width + 10);
    assert_true(pixels.y <= part.y - 10 && pixels.y + pixels.height >= part.y + part.height + 10);
    for (uint32_t number = 0, there = 0; number < whole.tile_count; number++) {
        uint32_t tile, lane, x, y, at_x, at_y, found;
        gbuffer_pixel(&whole, number, 17, &x, &y);
        bool has = gbuffer_tile_numbered(&window, number, &tile);
        assert_int_equal(gbuffer_find(&window, x, y, &found, &lane),
                         has && x < window.width && y < window.height);
        gbuffer_picture_pixel(&window, number, 17, &at_x, &at_y);
        assert_true(at_x == x && at_y == y);
        if (!has)
            continue;
        assert_int_equal(tile, there++);
        assert_int_equal(gbuffer_number(&window, tile), number);
        gbuffer_pixel(&window, tile, 17, &at_x, &at_y);
        assert_true(at_x == x && at_y == y);
        if (x < window.width && y < window.height)
            assert_true(found == tile && lane == 17);
    }
    /* a tile and those around it, and with smooth edges once more */
    const struct rectangle one_tile = {96, 80, 16, 16};
    window = gbuffer_layout_around(one_tile, false, 311, 190);
    assert_int_equal(window.tile_count, 9);
    window = gbuffer_layout_around(one_tile, true, 311, 190);
    assert_int_equal(window.tile_count, 25);
    window = gbuffer_layout_around((struct rectangle){0, 0, 311, 190}, true, 311, 190);
    assert_int_equal(window.tile_count, whole.tile_count);
}

/* Each pixel sees at a depth of its own. */
static void test_film_of_a_part(void **state)
{
    (void)state;
    struct gbuffer gbuffer;
    struct film film;
    struct error error;
    assert_int_equal(gbuffer_create(gbuffer_layout_around(part, true, 311, 190), &gbuffer, &error),
                     PS_OK);
    assert_int_equal(film_create(part.width, part.height, true, &film, &error), PS_OK);
    film.window = (struct picture_window){part.x, part.y, 311, 190};
    assert_int_equal(film_begin_pass(&film, 0, &error), PS_OK);
    for (uint32_t tile = 0, tiles = 0; tile < gbuffer.tile_count; tile++) {
        uint32_t x, y;
        gbuffer_clear_tile(&gbuffer, tile);
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            gbuffer_pixel(&gbuffer, tile, lane, &x, &y);
            see(&gbuffer.tiles[tile], &gbuffer.direct[(size_t)tile * PS_TILE_PIXELS], lane,
                (float)(y * 311 + x));
        }
        film_add_tile(&film, &gbuffer, tile, NULL);
        tiles += film_has_tile(&film, &gbuffer, tile);
        assert_true(tile + 1 < gbuffer.tile_count || tiles == 6); /* 3 x 2 */
    }
    for (size_t y = 0; y < part.height; y++)
        for (size_t x = 0; x < part.width; x++)
            assert_true(film.planes[FILM_DEPTH][y * part.width + x] ==
                        4 * (float)((part.y + y) * 311 + part.x + x));
    assert_true(film_has_pixel(&film, 101, 70) && film_has_pixel(&film, 130, 90));
    assert_false(film_has_pixel(&film, 100, 70) || film_has_pixel(&film, 131, 90) ||
                 film_has_pixel(&film, 101, 69) || film_has_pixel(&film, 130, 91));
    film_release(&film);
    gbuffer_release(&gbuffer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_window_of_a_part),
        cmocka_unit_test(test_film_of_a_part),
        FILM_TEST(test_lanes_are_pixels),
        FILM_TEST(test_new_film_is_empty),
        FILM_TEST(test_passes_add_up),
        FILM_TEST(test_average),
        FILM_TEST(test_partly_covered_pixels),
        FILM_TEST(test_uncovered_pixels),
        FILM_TEST(test_emission_is_added),
        FILM_TEST(test_film_of_light_alone),
        FILM_TEST(test_reflected_light_apart),
        FILM_TEST(test_half_of_a_pass),
        FILM_TEST(test_hard_light_apart),
        FILM_TEST(test_clear_indirect),
        FILM_TEST(test_samples_take_the_place_of_a_lane),
        FILM_TEST(test_many_samples_of_a_pixel),
        FILM_TEST(test_first_glossy_surface),
        FILM_TEST(test_variance),
        FILM_TEST(test_mirror_with_nothing_behind),
        FILM_TEST(test_mirror_beside_a_surface),
        FILM_TEST(test_albedo_is_no_more_than_1),
        FILM_TEST(test_halves_of_glossy_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
