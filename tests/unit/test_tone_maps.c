/* test_tone_maps.c: the curves of tonemap=filmic, reinhard and chroma, against their equations. */
#include "image/tonemap.h"
#include "support/display_picture.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <psplat/display.h>
#include <psplat/math.h>

static ps_rgb mapped(const char *choice, ps_rgb light)
{
    ps_rgb shown = light;
    const ps_display_view picture = {sizeof picture, 1, 1, 0, &shown.r, &shown.g, &shown.b};
    run_display(choice, 1, &picture, PS_OK);
    return shown;
}

/* 4096 greys, apart by 1/512, in one picture of 64 rows. */
enum { GREYS = 4096 };

static void map_greys(const char *choice, float (*shown)[GREYS])
{
    const ps_display_view picture = {sizeof picture, 64, 64, 0, shown[0], shown[1], shown[2]};
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GREYS; i++)
            shown[c][i] = (float)i / 512.0f;
    run_display(choice, 3, &picture, PS_OK);
}

static const char *const curves[] = {"tonemap=filmic", "tonemap=filmic:shoulder=0",
                                     "tonemap=reinhard:white=9", "tonemap=chroma"};

/* From 0 upwards, grey stays grey, and there are no corners: slopes of neighbours differ by what a
 * curve bends, which is at most 2 over a step. */
static void test_curves_rise_smoothly(void **state)
{
    (void)state;
    static float shown[3][GREYS];
    const double step = 1.0 / 512.0;
    for (size_t k = 0; k < sizeof curves / sizeof curves[0]; k++) {
        map_greys(curves[k], shown);
        assert_float_equal(shown[0][0], 0.0f, 0.0f);
        for (int i = 1; i + 1 < GREYS; i++) {
            double before = ((double)shown[0][i] - (double)shown[0][i - 1]) / step;
            double after = ((double)shown[0][i + 1] - (double)shown[0][i]) / step;
            assert_true(before >= -1e-4 && shown[0][i] <= 1.0f);
            assert_true(fabs(after - before) < 3.0 * step + 2e-4);
            assert_float_equal(shown[1][i], shown[0][i], 1e-6f);
            assert_float_equal(shown[2][i], shown[0][i], 1e-6f);
        }
    }
}

static void test_filmic(void **state)
{
    (void)state;
    ps_rgb shown = mapped("tonemap=filmic", (ps_rgb){0.3f, 1.0f, 2.0f});
    assert_float_equal(shown.r, 0.3f, 1e-7f);
    assert_float_equal(shown.g, 1.0 - 0.4 * exp(-1.0), 1e-6f);
    assert_float_equal(shown.b, 1.0 - 0.4 * exp(-3.5), 1e-6f);
    shown = mapped("tonemap=filmic:shoulder=0", (ps_rgb){0.3f, 1.0f, 2.0f});
    assert_float_equal(shown.r, 1.0 - exp(-0.3), 1e-6f);
}

/* Pictures that are drawn without plugins are as those of the default. */
static void test_filmic_is_that_of_the_image(void **state)
{
    (void)state;
    static float shown[3][GREYS];
    map_greys("tonemap=filmic", shown);
    for (int i = 0; i < GREYS; i++) {
        float linear = (float)i / 512.0f;
        uint8_t drawn[3], mapped_bytes[3];
        tonemap_planes(&linear, &linear, &linear, 1, 0.0, TONE_FILMIC, drawn);
        tonemap_planes(&shown[0][i], &shown[0][i], &shown[0][i], 1, 0.0, TONE_CLIP, mapped_bytes);
        assert_memory_equal(drawn, mapped_bytes, 3);
    }
}

static void test_reinhard(void **state)
{
    (void)state;
    /* L (1 + L / 16) / (1 + L) */
    assert_float_equal(mapped("tonemap=reinhard", (ps_rgb){1, 1, 1}).g, 0.53125f, 1e-6f);
    assert_float_equal(mapped("tonemap=reinhard", (ps_rgb){4, 4, 4}).g, 1.0f, 1e-6f);
    assert_float_equal(mapped("tonemap=reinhard:white=2", (ps_rgb){2, 2, 2}).b, 1.0f, 1e-6f);
    ps_rgb shown = mapped("tonemap=reinhard", (ps_rgb){1.0f, 0.5f, 0.25f}); /* ratios stay */
    assert_float_equal(shown.r, 2.0f * shown.g, 1e-6f);
    assert_float_equal(shown.g, 2.0f * shown.b, 1e-6f);
}

/* Hue in linear light: where the middle channel lies between the others. */
static double hue(ps_rgb c)
{
    return (double)(c.g - c.b) / (double)(c.r - c.b);
}

static void test_chroma_keeps_hue_and_luminance(void **state)
{
    (void)state;
    const ps_rgb orange = {1.0f, 0.5f, 0.1f};
    for (int i = 1; i <= 20; i++) {
        ps_rgb light = ps_rgb_scale(orange, 0.2f * (float)i);
        ps_rgb shown = mapped("tonemap=chroma", light);
        double luminance = ps_shoulder((double)ps_luminance(light), 0.6);
        assert_true(shown.r <= 1.0f + 1e-6f && shown.b >= 0.0f);
        assert_float_equal(ps_luminance(shown), luminance, 1e-5);
        assert_float_equal(hue(shown), hue(orange), 1e-3);
    }
    /* Cut off channel by channel, orange turns to yellow. */
    ps_rgb cut = mapped("tonemap=filmic", ps_rgb_scale(orange, 4.0f));
    assert_true(hue(cut) > 1.5 * hue(orange));
}

/* The extremes of what psplat hands on: no NaN, no infinity, nothing above 1. */
static void test_extremes(void **state)
{
    (void)state;
    const float values[] = {0.0f, FLT_MIN, 1e-20f, 1.0f, 1e20f, FLT_MAX};
    const int count = sizeof values / sizeof values[0];
    for (size_t k = 0; k < sizeof curves / sizeof curves[0]; k++)
        for (int i = 0; i < count * count; i++) {
            ps_rgb light = {values[i % count], values[i / count], 0.0f};
            ps_rgb shown = mapped(curves[k], light);
            assert_true(shown.r >= 0.0f && shown.r <= 1.0f + 1e-6f);
            assert_true(shown.g >= 0.0f && shown.g <= 1.0f + 1e-6f);
            assert_true(shown.b >= 0.0f && shown.b <= 1.0f + 1e-6f);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_curves_rise_smoothly),           cmocka_unit_test(test_filmic),
        cmocka_unit_test(test_filmic_is_that_of_the_image),    cmocka_unit_test(test_reinhard),
        cmocka_unit_test(test_chroma_keeps_hue_and_luminance), cmocka_unit_test(test_extremes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
