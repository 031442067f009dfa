/* test_texture.c: looking a texture up: where texels lie, wrapping, interpolation, decoding. */
#include "texture_fixture.h"

#define WIDTH 4
#define HEIGHT 3

/* Texel (column, row from the bottom) of the test's picture has 1 + column + 10 row, 0, 0. */
static float value_at(int column, int row)
{
    return (float)(1 + column + 10 * row);
}

static struct texture create(float samples[WIDTH * HEIGHT], enum texture_wrap wrap, bool nearest)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        samples[i] = value_at(i % WIDTH, HEIGHT - 1 - i / WIDTH);
    }
    struct texture texture = texture_of(samples, WIDTH, HEIGHT, 1);
    texture.wrap_u = texture.wrap_v = wrap;
    texture.nearest = nearest;
    return texture;
}

static float look_up(const struct texture *texture, double u, double v)
{
    float rgba[4];
    texture_sample(texture, (float)u, (float)v, rgba);
    assert_float_equal(rgba[1], rgba[0], 0);
    assert_float_equal(rgba[2], rgba[0], 0);
    assert_float_equal(rgba[3], 1, 0);
    return rgba[0];
}

/* At a place in texels, counted from the lower left corner. */
static float look_up_texels(const struct texture *texture, double x, double y)
{
    return look_up(texture, x / WIDTH, y / HEIGHT);
}

static void test_centers(void **state)
{
    float samples[WIDTH * HEIGHT];
    (void)state;
    for (int wrap = WRAP_REPEAT; wrap <= WRAP_MIRROR; wrap++) {
        for (int nearest = 0; nearest < 2; nearest++) {
            struct texture texture = create(samples, wrap, nearest);
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                int column = i % WIDTH, row = i / WIDTH;
                float expected = value_at(column, row);
                assert_float_equal(look_up_texels(&texture, column + 0.5, row + 0.5), expected,
                                   1e-4);
            }
        }
    }
}

static void test_orientation(void **state)
{
    float rgba[4];
    (void)state;
    struct texture texture = load_data("rgb8.png", ENCODING_LINEAR);
    texture_sample(&texture, 0.1f, 0.9f, rgba); /* the file's first pixel: red */
    assert_color(rgba, 1, 0, 0, 1, 0);
    texture_sample(&texture, 0.9f, 0.9f, rgba);
    assert_color(rgba, 0, 0, 1, 1, 0);
    texture_sample(&texture, 0.1f, 0.1f, rgba);
    assert_color(rgba, 0, 0, 0, 1, 0);
    texture_sample(&texture, 0.9f, 0.1f, rgba); /* its last: white */
    assert_color(rgba, 1, 1, 1, 1, 0);
    texture_release(&texture);
}

static void test_bilinear_weights(void **state)
{
    float samples[WIDTH * HEIGHT];
    struct texture texture = create(samples, WRAP_CLAMP, false);
    (void)state;
    for (double x = 0.5; x <= WIDTH - 0.5; x += 0.125) {
        for (double y = 0.5; y <= HEIGHT - 0.5; y += 0.125) {
            float expected = (float)(1 + (x - 0.5) + 10 * (y - 0.5));
            assert_float_equal(look_up_texels(&texture, x, y), expected, 1e-5);
        }
    }
    /* A product of shares: linear data alone would not tell. */
    float square[4] = {0, 1, 0, 0};
    texture = texture_of(square, 2, 2, 1);
    texture.wrap_u = texture.wrap_v = WRAP_CLAMP;
    assert_float_equal(look_up(&texture, 0.25 + 0.3 * 0.5, 0.25 + 0.6 * 0.5), 0.3 * 0.6, 1e-6);
}

static void test_nearest_edges(void **state)
{
    float samples[WIDTH * HEIGHT];
    (void)state;
    for (int wrap = WRAP_REPEAT; wrap <= WRAP_MIRROR; wrap++) {
        struct texture texture = create(samples, wrap, true);
        for (int column = 0; column < WIDTH; column++) {
            assert_float_equal(look_up_texels(&texture, column + 0.001, 0.5), value_at(column, 0),
                               0);
            assert_float_equal(look_up_texels(&texture, column + 0.999, 0.5), value_at(column, 0),
                               0);
            assert_float_equal(look_up(&texture, column / 4.0, 0.1), value_at(column, 0), 0);
        }
    }
}

static void test_repeat(void **state)
{
    float samples[WIDTH * HEIGHT];
    (void)state;
    for (int nearest = 0; nearest < 2; nearest++) {
        struct texture texture = create(samples, WRAP_REPEAT, nearest);
        for (int tile = -3; tile <= 3; tile++) {
            for (double x = 0.0625; x < 1; x += 0.125) {
                float here = look_up(&texture, x, 0.3);
                assert_float_equal(look_up(&texture, x + tile, 0.3), here, 1e-5);
                assert_float_equal(look_up(&texture, x, 0.3 + tile), here, 2e-5);
            }
        }
    }
    struct texture texture = create(samples, WRAP_REPEAT, false);
    float middle = 0.5f * (value_at(0, 1) + value_at(WIDTH - 1, 1));
    assert_float_equal(look_up(&texture, 0, 0.5), middle, 1e-5);
    assert_float_equal(look_up(&texture, 1, 0.5), middle, 1e-5);
    middle = 0.5f * (value_at(0, 0) + value_at(0, HEIGHT - 1));
    assert_float_equal(look_up_texels(&texture, 0.5, 0), middle, 1e-5);
    assert_float_equal(look_up_texels(&texture, 0.5, HEIGHT), middle, 1e-5);
}

static void test_clamp(void **state)
{
    float samples[WIDTH * HEIGHT];
    (void)state;
    for (int nearest = 0; nearest < 2; nearest++) {
        struct texture texture = create(samples, WRAP_CLAMP, nearest);
        static const double beyond[] = {0, -0.01, -1, -1e30, -INFINITY};
        for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
            assert_float_equal(look_up(&texture, beyond[i], beyond[i]), value_at(0, 0), 0);
            assert_float_equal(look_up(&texture, 1 - beyond[i], 1 - beyond[i]),
                               value_at(WIDTH - 1, HEIGHT - 1), 0);
        }
    }
}

static void test_mirror(void **state)
{
    float samples[WIDTH * HEIGHT];
    (void)state;
    for (int nearest = 0; nearest < 2; nearest++) {
        struct texture texture = create(samples, WRAP_MIRROR, nearest);
        for (double x = 0.0625; x < 1; x += 0.125) {
            float here = look_up(&texture, x, 0.3);
            assert_float_equal(look_up(&texture, -x, 0.3), here, 1e-5);
            assert_float_equal(look_up(&texture, 2 - x, 0.3), here, 1e-5);
            assert_float_equal(look_up(&texture, 4 + x, 0.3), here, 1e-5);
            assert_float_equal(look_up(&texture, x - 2, -0.3), here, 1e-5);
        }
        assert_float_equal(look_up(&texture, 0, 0), value_at(0, 0), 0);
        assert_float_equal(look_up(&texture, 1, 1), value_at(WIDTH - 1, HEIGHT - 1), 0);
    }
}

static void test_single_texel(void **state)
{
    float sample = 5;
    (void)state;
    for (int wrap = WRAP_REPEAT; wrap <= WRAP_MIRROR; wrap++) {
        struct texture texture = texture_of(&sample, 1, 1, 1);
        texture.wrap_u = texture.wrap_v = wrap;
        for (double u = -2; u <= 2; u += 0.1) {
            assert_float_equal(look_up(&texture, u, -u), 5, 1e-5);
        }
    }
}

static void test_each_axis_wraps_by_itself(void **state)
{
    float samples[WIDTH * HEIGHT];
    (void)state;
    struct texture texture = create(samples, WRAP_CLAMP, true);
    texture.wrap_v = WRAP_REPEAT;
    assert_float_equal(look_up_texels(&texture, WIDTH + 0.5, HEIGHT + 0.5), value_at(WIDTH - 1, 0),
                       0);
    texture.wrap_u = WRAP_MIRROR;
    texture.wrap_v = WRAP_CLAMP;
    assert_float_equal(look_up_texels(&texture, -1.5, -1.5), value_at(1, 0), 0);
}

/* Half way between black and white there is half the light, not half the code. */
static void test_decoded_before_interpolation(void **state)
{
    float rgba[4];
    (void)state;
    struct texture texture = load_data("grey1.png", ENCODING_AUTO); /* 0 1 1 over 1 0 0 */
    texture.nearest = false;
    texture.wrap_u = texture.wrap_v = WRAP_CLAMP;
    texture_sample(&texture, 1.0f / 3.0f, 1.0f, rgba);
    assert_color(rgba, 0.5f, 0.5f, 0.5f, 1, 1e-6f);
    texture_release(&texture);
    texture = load_data("grey8.png", ENCODING_AUTO); /* 100 over 255 on the right */
    texture.nearest = false;
    texture.wrap_u = texture.wrap_v = WRAP_CLAMP;
    texture_sample(&texture, 1.0f, 0.5f, rgba);
    float expected = 0.5f * (1.0f + powf((100 / 255.0f + 0.055f) / 1.055f, 2.4f));
    assert_color(rgba, expected, expected, expected, 1, 1e-6f);
    texture_release(&texture);
}

static void test_any_coordinate(void **state)
{
    static const float wild[] = {NAN,    INFINITY, -INFINITY, 1e38f,   -1e38f, 8388607.5f,
                                 1e-40f, -1e-40f,  -1e-9f,    0x1p31f, 3e9f,   -0.0f};
    float samples[WIDTH * HEIGHT];
    (void)state;
    for (int mode = 0; mode < 6; mode++) {
        struct texture texture = create(samples, mode / 2, mode % 2);
        for (size_t i = 0; i < 12; i++) {
            for (size_t k = 0; k < 12; k++) {
                float value = look_up(&texture, wild[i], wild[k]);
                assert_true(value >= 1 && value <= value_at(WIDTH - 1, HEIGHT - 1));
            }
        }
    }
}

/* No difference of texels may overflow. */
static void test_large_texels(void **state)
{
    float samples[2] = {3e38f, -3e38f};
    struct texture texture = texture_of(samples, 2, 1, 1);
    (void)state;
    assert_true(fabsf(look_up(&texture, 0.5, 0.5)) < 1e32f);
    assert_true(look_up(&texture, 0.25, 0.5) == 3e38f);
}

static void test_memory(void **state)
{
    (void)state;
    struct texture texture = load_data("rgb8.png", ENCODING_AUTO);
    assert_int_equal(texture_bytes(&texture), 3 * 2 * 3 + 256 * sizeof(float));
    texture_release(&texture);
    texture = load_data("rgba8.png", ENCODING_AUTO);
    assert_int_equal(texture_bytes(&texture), 3 * 2 * 4 + 2 * 256 * sizeof(float));
    texture_release(&texture);
    texture = load_data("grey16.png", ENCODING_AUTO);
    assert_int_equal(texture_bytes(&texture), 3 * 2 * 2 + 65536 * sizeof(float));
    texture_release(&texture);
    assert_null(texture.color_of);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_centers),
        cmocka_unit_test(test_orientation),
        cmocka_unit_test(test_bilinear_weights),
        cmocka_unit_test(test_nearest_edges),
        cmocka_unit_test(test_repeat),
        cmocka_unit_test(test_clamp),
        cmocka_unit_test(test_mirror),
        cmocka_unit_test(test_single_texel),
        cmocka_unit_test(test_decoded_before_interpolation),
        cmocka_unit_test(test_each_axis_wraps_by_itself),
        cmocka_unit_test(test_any_coordinate),
        cmocka_unit_test(test_large_texels),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
