/* test_tonemap.c: exposure, curves, the sRGB function and rounding, against values worked out by
 * hand from IEC 61966-2-1. */
#include "image/tonemap.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>

static uint8_t shown(float linear, double stops, enum tone_curve curve)
{
    uint8_t rgb[3];
    tonemap_planes(&linear, &linear, &linear, 1, stops, curve, rgb);
    assert_int_equal(rgb[0], rgb[1]);
    assert_int_equal(rgb[0], rgb[2]);
    return rgb[0];
}

static void test_srgb_known_values(void **state)
{
    (void)state;
    assert_float_equal(tonemap_srgb(0.0f), 0.0f, 0.0f);
    assert_float_equal(tonemap_srgb(1.0f), 1.0f, 0.0f);
    assert_float_equal(tonemap_srgb(0.0031308f), 0.04044993f, 1e-6f);
    assert_float_equal(tonemap_srgb(0.001f), 0.01292f, 1e-7f);
    assert_float_equal(tonemap_srgb(0.5f), 0.7353570f, 1e-6f);
    assert_float_equal(tonemap_srgb(0.18f), 0.4613561f, 1e-6f);
}

static void test_srgb_clamps(void **state)
{
    (void)state;
    assert_float_equal(tonemap_srgb(-1.0f), 0.0f, 0.0f);
    assert_float_equal(tonemap_srgb(2.0f), 1.0f, 0.0f);
    assert_float_equal(tonemap_srgb(INFINITY), 1.0f, 0.0f);
    assert_float_equal(tonemap_srgb(-INFINITY), 0.0f, 0.0f);
    assert_float_equal(tonemap_srgb(NAN), 0.0f, 0.0f);
}

static void test_bytes(void **state)
{
    (void)state;
    assert_int_equal(shown(0.5f, 0.0, TONE_CLIP), 188);
    assert_int_equal(shown(1.0f, 0.0, TONE_CLIP), 255);
    assert_int_equal(shown(0.0f, 0.0, TONE_CLIP), 0);
    assert_int_equal(shown(0.2158605f, 0.0, TONE_CLIP), 128); /* ((128/255 + 0.055) / 1.055)^2.4 */
}

/* Half a step below and above each byte's own value, less a little, must round to that byte. */
static void test_rounding(void **state)
{
    (void)state;
    for (int byte = 0; byte < 256; byte++) {
        for (int side = -1; side <= 1; side++) {
            double display = (byte + 0.499 * side) / 255.0;
            double linear =
                display <= 0.04045 ? display / 12.92 : pow((display + 0.055) / 1.055, 2.4);
            assert_int_equal(shown((float)linear, 0.0, TONE_CLIP), byte);
        }
    }
}

static void test_values_without_a_colour(void **state)
{
    (void)state;
    for (enum tone_curve curve = TONE_CLIP; curve <= TONE_FILMIC; curve++) {
        assert_int_equal(shown(NAN, 0.0, curve), 0);
        assert_int_equal(shown(INFINITY, 0.0, curve), 255);
        assert_int_equal(shown(-INFINITY, 0.0, curve), 0);
        assert_int_equal(shown(-0.5f, 0.0, curve), 0);
        assert_int_equal(shown(FLT_MAX, 10.0, curve), 255);
    }
}

static void test_exposure(void **state)
{
    (void)state;
    assert_int_equal(shown(0.25f, 1.0, TONE_CLIP), 188);
    assert_int_equal(shown(1.0f, -1.0, TONE_CLIP), 188);
    assert_int_equal(shown(0.35355339f, 0.5, TONE_CLIP), 188);
}

static void test_filmic_curve(void **state)
{
    (void)state;
    for (float linear = 0.0f; linear <= 0.6f; linear += 0.01f) {
        assert_int_equal(shown(linear, 0.0, TONE_FILMIC), shown(linear, 0.0, TONE_CLIP));
    }
    uint8_t last = 0;
    for (float linear = 0.0f; linear < 8.0f; linear += 0.001f) {
        uint8_t next = shown(linear, 0.0, TONE_FILMIC);
        assert_true(next >= last && next <= last + 10);
        if (linear > 0.6f) {
            float expected = tonemap_srgb((float)(1.0 - 0.4 * exp((0.6 - linear) / 0.4)));
            assert_float_equal(next, 255.0f * expected, 0.501f);
        }
        last = next;
    }
    assert_int_equal(last, 255);
    /* 1 - 0.4 exp(-1) = 0.852848; sRGB 0.931896 */
    assert_int_equal(shown(1.0f, 0.0, TONE_FILMIC), 238);
}

static void test_channels_keep_their_places(void **state)
{
    (void)state;
    const float red[] = {1.0f, 0.0f}, green[] = {0.5f, 1.0f}, blue[] = {0.0f, 0.5f};
    uint8_t rgb[7] = {9, 9, 9, 9, 9, 9, 77};
    tonemap_planes(red, green, blue, 2, 0.0, TONE_CLIP, rgb);
    const uint8_t expected[] = {255, 188, 0, 0, 255, 188, 77};
    assert_memory_equal(rgb, expected, sizeof expected);
}

static double display_of(float linear)
{
    return 255.0 * (double)tonemap_srgb(linear);
}

/* Both bytes around a value come, as often as makes their mean the value: over 16x16 pixels,
 * wherever they lie. */
static void test_dither(void **state)
{
    uint8_t rgb[16][16][3];
    float plane[16];
    (void)state;
    for (int step = 0; step <= 200; step++) {
        float linear = (float)step / 200.0f;
        double sum = 0, value = display_of(linear);
        for (int i = 0; i < 16; i++)
            plane[i] = linear;
        for (uint32_t y = 0; y < 16; y++) {
            tonemap_row(plane, plane, plane, 16, 37 * (uint32_t)step, y + 11, rgb[y][0]);
            for (int x = 0; x < 16; x++) {
                assert_true(fabs(rgb[y][x][0] - value) < 1);
                assert_int_equal(rgb[y][x][0], rgb[y][x][2]);
                sum += rgb[y][x][1];
            }
        }
        assert_float_equal(sum / 256, value, 0.05);
    }
}

static void test_steps_are_not_dithered(void **state)
{
    (void)state;
    for (int byte = 0; byte < 256; byte++) {
        float linear = (float)tonemap_linear(byte / 255.0);
        for (uint32_t x = 0; x < 100; x++) {
            uint8_t rgb[3];
            tonemap_row(&linear, &linear, &linear, 1, x, 5, rgb);
            assert_int_equal(rgb[0], byte);
        }
    }
}

/* A pixel does not depend on what is encoded beside it. */
static void test_dither_is_a_pixels_own(void **state)
{
    float plane[64];
    uint8_t whole[64][3], part[3];
    (void)state;
    for (int i = 0; i < 64; i++)
        plane[i] = 0.2f + 0.001f * (float)i;
    tonemap_row(plane, plane, plane, 64, 100, 9, whole[0]);
    for (uint32_t i = 0; i < 64; i++) {
        tonemap_row(plane + i, plane + i, plane + i, 1, 100 + i, 9, part);
        assert_int_equal(part[1], whole[i][1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_srgb_known_values),
        cmocka_unit_test(test_srgb_clamps),
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_rounding),
        cmocka_unit_test(test_values_without_a_colour),
        cmocka_unit_test(test_exposure),
        cmocka_unit_test(test_filmic_curve),
        cmocka_unit_test(test_channels_keep_their_places),
        cmocka_unit_test(test_dither),
        cmocka_unit_test(test_steps_are_not_dithered),
        cmocka_unit_test(test_dither_is_a_pixels_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
