/* test_debug_drawing.c: what pictures of debug are drawn with: letters, discs, colours of numbers,
 * scales, and pixels made large. */
#include "debug/font.h"
#include "debug/id_colour.h"
#include "debug/legend.h"
#include "image/magnify.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct colour white = {255, 255, 255};

static bool same(struct colour a, struct colour b)
{
    return a.r == b.r && a.g == b.g && a.b == b.b;
}

static void create(struct canvas *canvas, size_t width, size_t height)
{
    struct error error;
    assert_int_equal(canvas_create(canvas, width, height, &error), PS_OK);
}

static uint64_t bits_of(char letter)
{
    uint64_t bits = 0;
    for (size_t row = 0; row < FONT_HEIGHT; row++)
        for (size_t column = 0; column < FONT_WIDTH; column++)
            bits = bits << 1 | font_pixel(letter, column, row);
    return bits;
}

static void test_letters_differ(void **state)
{
    (void)state;
    static const char used[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ.,:-+/%()=? ";
    for (size_t i = 0; used[i]; i++)
        for (size_t j = 0; j < i; j++)
            assert_true(bits_of(used[i]) != bits_of(used[j]));
    assert_true(bits_of('q') == bits_of('Q'));
    assert_true(bits_of('~') == bits_of('?') && bits_of((char)0xe4) == bits_of('?'));
    assert_true(bits_of(' ') == 0);
}

/* The letter T by what makes it one: a bar above a stem. */
static void test_letters_stand_upright(void **state)
{
    (void)state;
    for (size_t column = 0; column < FONT_WIDTH; column++) {
        assert_true(font_pixel('T', column, 0));
        assert_int_equal(font_pixel('T', column, FONT_HEIGHT - 1), column == 2);
        assert_true(font_pixel('L', column, FONT_HEIGHT - 1)); /* and L, left from right */
    }
    for (size_t row = 0; row + 1 < FONT_HEIGHT; row++)
        assert_true(font_pixel('L', 0, row) && !font_pixel('L', FONT_WIDTH - 1, row));
}

static void test_text_is_drawn_and_cut_off(void **state)
{
    (void)state;
    struct canvas canvas;
    create(&canvas, 20, 14);
    canvas_text(&canvas, 0, 0, 2, white, "LL"); /* needs 22 x 14 */
    assert_int_equal(canvas_text_width(2, "LL"), 22);
    assert_int_equal(canvas_text_width(2, ""), 0);
    for (size_t y = 0; y < 14; y++)
        for (size_t x = 0; x < 20; x++) {
            bool in_letter = x % 12 / 2 < FONT_WIDTH && font_pixel('L', x % 12 / 2, y / 2);
            assert_true(same(canvas_get(&canvas, x, y), white) == in_letter);
        }
    canvas_text(&canvas, -100, 50, 1, white, "outside");
    canvas_release(&canvas);
}

static void test_disc(void **state)
{
    (void)state;
    struct canvas canvas;
    size_t pixels = 0;
    create(&canvas, 40, 40);
    canvas_disc(&canvas, 20.0f, 20.0f, 10.0f, white);
    for (size_t i = 0; i < 1600; i++)
        pixels += same(canvas_get(&canvas, i % 40, i / 40), white);
    assert_true(pixels > 300 && pixels < 330); /* 314.2 */
    canvas_disc(&canvas, 3.9f, 2.1f, 0.1f, white);
    assert_true(same(canvas_get(&canvas, 3, 2), white));
    canvas_disc(&canvas, -5.0f, 45.0f, 3.0f, white); /* outside */
    canvas_release(&canvas);
}

static void test_ids_have_colours_of_their_own(void **state)
{
    (void)state;
    size_t alike = 0;
    for (uint64_t id = 0; id < 1000; id++) {
        struct colour colour = id_colour(id), next = id_colour(id + 1);
        int apart = abs(colour.r - next.r) + abs(colour.g - next.g) + abs(colour.b - next.b);
        int brightest = colour.r > colour.g ? colour.r : colour.g;
        brightest = colour.b > brightest ? colour.b : brightest;
        assert_true(brightest >= 128);
        assert_true(same(colour, id_colour(id)));
        alike += apart < 24;
    }
    assert_true(alike < 50); /* neighbours that can't be told apart: by chance */
}

static void test_scales_are_round(void **state)
{
    (void)state;
    static const double cases[][2] = {{1, 1},     {1.01, 1.5}, {599, 600},   {600, 600},
                                      {601, 800}, {810, 1000}, {0.07, 0.08}, {1710, 2000},
                                      {0, 1},     {-3, 1},     {1e6, 1e6},   {3.2e-5, 4e-5}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_true(fabs(legend_top(cases[i][0]) / cases[i][1] - 1) < 1e-9);
    for (double top = 0.013; top < 1e7; top *= 1.17)
        for (size_t most = 2; most < 12; most++) {
            double numbers = top / legend_step(top, most);
            assert_true(numbers <= (double)most * (1 + 1e-6) && numbers >= (double)most / 3);
        }
    assert_true(fabs(legend_step(2000, 5) - 500) < 1e-6);
}

static void test_colours_of_a_scale(void **state)
{
    (void)state;
    struct legend_scale whole = {2000, 0}, part = {2000, 0.5};
    assert_true(same(legend_colour(&whole, 0), (struct colour){0, 0, 4}));
    assert_true(same(legend_colour(&whole, 2000), (struct colour){252, 253, 191}));
    assert_true(same(legend_colour(&whole, 9000), legend_colour(&whole, 2000)));
    assert_true(same(legend_colour(&whole, 1000), (struct colour){181, 54, 122}));
    assert_true(same(legend_colour(&part, 0), legend_colour(&whole, 1000)));
    assert_true(same(legend_colour(&part, 1000), legend_colour(&whole, 1500)));
    assert_true(same(legend_colour(&part, -7), legend_colour(&part, 0)));
}

/* The strip's ramp runs over the whole scale, from margin to margin. */
static void test_legend_holds_its_colours(void **state)
{
    (void)state;
    struct canvas canvas;
    struct legend_scale scale = {2000, 0.2};
    size_t rows = 0;
    create(&canvas, 400, legend_height(400));
    legend_draw_scale(&canvas, 0, "splats", &scale);
    for (size_t y = 0; y < canvas.height; y++) {
        bool ramp = true;
        for (size_t x = 4; x < 396; x++)
            ramp = ramp && same(canvas_get(&canvas, x, y),
                                legend_colour(&scale, 2000 * ((double)x - 3.5) / 392));
        rows += ramp;
    }
    assert_int_equal(rows, 8);
    canvas_release(&canvas);
}

/* Numbers stand below their places: those of 0, 500, 1000, ... begin or are centred there. */
static void test_legend_has_its_ticks(void **state)
{
    (void)state;
    static const struct colour paper = {24, 24, 24};
    struct canvas canvas;
    struct legend_scale scale = {2000, 0};
    size_t ticks = 0, y = 4 + FONT_HEIGHT + 3 + 8;
    create(&canvas, 400, legend_height(400));
    legend_draw_scale(&canvas, 0, "splats", &scale);
    for (size_t x = 0; x < 400; x++)
        if (!same(canvas_get(&canvas, x, y), paper)) {
            assert_true(fabs((double)x - 4 - 391 * (double)ticks / 4) <= 1);
            ticks++;
        }
    assert_int_equal(ticks, 5);
    canvas_release(&canvas);
}

static void test_series_has_hues_apart(void **state)
{
    (void)state;
    for (unsigned i = 1; i <= 9; i++)
        for (unsigned j = 1; j < i; j++) {
            struct colour a = series_colour(i), b = series_colour(j);
            assert_true(abs(a.r - b.r) + abs(a.g - b.g) + abs(a.b - b.b) > 60);
        }
}

static void test_magnified_pixels_are_squares(void **state)
{
    (void)state;
    uint8_t small[3 * 5 * 4], large[3 * 6 * 9];
    for (size_t i = 0; i < sizeof small; i++)
        small[i] = (uint8_t)(i * 7);
    magnify(small, 5, (struct rectangle){2, 1, 2, 3}, 3, large);
    for (size_t y = 0; y < 9; y++)
        for (size_t x = 0; x < 6; x++)
            assert_memory_equal(large + 3 * (y * 6 + x), small + 3 * ((1 + y / 3) * 5 + 2 + x / 3),
                                3);
}

static void test_parts_fit_or_not(void **state)
{
    (void)state;
    assert_true(rectangle_fits((struct rectangle){0, 0, 4, 3}, 4, 3));
    assert_true(rectangle_fits((struct rectangle){3, 2, 1, 1}, 4, 3));
    assert_false(rectangle_fits((struct rectangle){3, 2, 2, 1}, 4, 3));
    assert_false(rectangle_fits((struct rectangle){3, 2, 1, 2}, 4, 3));
    assert_false(rectangle_fits((struct rectangle){4, 0, 1, 1}, 4, 3));
    assert_false(rectangle_fits((struct rectangle){0, 0, 0, 3}, 4, 3));
    assert_false(rectangle_fits((struct rectangle){1, 0, SIZE_MAX, 1}, 4, 3));
}

static void test_paste_is_cut_off(void **state)
{
    (void)state;
    struct canvas canvas;
    uint8_t pixels[3 * 4 * 4];
    memset(pixels, 255, sizeof pixels);
    create(&canvas, 6, 5);
    canvas_paste(&canvas, 4, 3, pixels, 4, 4);
    for (size_t i = 0; i < 30; i++)
        assert_true(same(canvas_get(&canvas, i % 6, i / 6), white) == (i % 6 >= 4 && i / 6 >= 3));
    canvas_paste(&canvas, 7, 9, pixels, 4, 4);
    canvas_release(&canvas);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_letters_differ),
        cmocka_unit_test(test_letters_stand_upright),
        cmocka_unit_test(test_text_is_drawn_and_cut_off),
        cmocka_unit_test(test_disc),
        cmocka_unit_test(test_ids_have_colours_of_their_own),
        cmocka_unit_test(test_scales_are_round),
        cmocka_unit_test(test_colours_of_a_scale),
        cmocka_unit_test(test_legend_holds_its_colours),
        cmocka_unit_test(test_legend_has_its_ticks),
        cmocka_unit_test(test_series_has_hues_apart),
        cmocka_unit_test(test_magnified_pixels_are_squares),
        cmocka_unit_test(test_parts_fit_or_not),
        cmocka_unit_test(test_paste_is_cut_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
