/* test_mip_map.c: levels of a picture have its means, and look-ups choose among them. */
#include "scene/mip_map.h"

#include "image/half.h"
#include "texture_fixture.h"
#include <float.h>

static void test_level_counts(void **state)
{
    (void)state;
    assert_int_equal(mip_map_level_count(1, 1), 1);
    assert_int_equal(mip_map_level_count(2, 1), 2);
    assert_int_equal(mip_map_level_count(3, 3), 2);
    assert_int_equal(mip_map_level_count(5, 1024), 11);
    assert_int_equal(mip_map_level_count(RASTER_SIDE_LIMIT, 1), TEXTURE_LEVELS);
    assert_int_equal(mip_map_half(7), 3);
    assert_int_equal(mip_map_half(1), 1);
}

static void add_levels(struct texture *texture)
{
    struct error error;
    assert_int_equal(mip_map_add(texture, &error), PS_OK);
}

/* The only texel of the last level. */
static void read_last(const struct texture *texture, float rgba[4])
{
    const struct texels *last = &texture->levels[texture->level_count - 1];
    assert_int_equal(last->width, 1);
    assert_int_equal(last->height, 1);
    texture_values(texture, last->bytes, rgba);
}

/* Whatever the code, and on sides that are odd: levels of one colour have that colour. */
static void test_colors_stay(void **state)
{
    (void)state;
    for (int srgb = 0; srgb < 2; srgb++)
        for (uint32_t code = 0; code <= UINT8_MAX; code++) {
            struct texture texture = texture_create(RASTER_BYTE, srgb, 7, 12, 3);
            memset(texture.raster.samples, (int)code, 7 * 12 * 3);
            add_levels(&texture);
            for (uint32_t level = 1; level < texture.level_count; level++) {
                const struct texels *texels = &texture.levels[level];
                for (uint32_t i = 0; i < texels->width * texels->height * 3; i++)
                    assert_int_equal(texels->bytes[i], code);
            }
            texture_release(&texture);
        }
    for (uint32_t code = 0; code <= UINT16_MAX; code += 13) {
        struct texture texture = texture_create(RASTER_SHORT, code % 2, 2, 2, 1);
        for (int i = 0; i < 4; i++)
            ((uint16_t *)texture.raster.samples)[i] = (uint16_t)code;
        add_levels(&texture);
        assert_int_equal(((const uint16_t *)texture.halves)[0], code);
        texture_release(&texture);
    }
}

static uint32_t random_number(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static void fill(struct texture *texture)
{
    size_t count = (size_t)texture->width * texture->height * texture->raster.channels;
    uint32_t state = 5;
    for (size_t i = 0; i < count; i++) {
        uint32_t number = random_number(&state);
        switch (texture->raster.sample) {
        case RASTER_BYTE:
            ((uint8_t *)texture->raster.samples)[i] = (uint8_t)number;
            break;
        case RASTER_SHORT:
            ((uint16_t *)texture->raster.samples)[i] = (uint16_t)number;
            break;
        case RASTER_HALF:
            ((uint16_t *)texture->raster.samples)[i] = half_from_float((float)number * 0x1p-20f);
            break;
        case RASTER_FLOAT:
            ((float *)texture->raster.samples)[i] = (float)number * 0x1p-20f;
            break;
        }
    }
}

static void expect_mean(enum raster_sample sample, bool srgb, uint32_t width, uint32_t height,
                        uint32_t channels)
{
    struct texture texture = texture_create(sample, srgb, width, height, channels);
    double sums[4] = {0, 0, 0, 0};
    float last[4];
    fill(&texture);
    add_levels(&texture);
    for (uint32_t i = 0; i < width * height; i++) {
        float values[4];
        texture_values(&texture, texture.levels[0].bytes + i * texture.texel_bytes, values);
        for (uint32_t channel = 0; channel < channels; channel++)
            sums[channel] += values[channel];
    }
    read_last(&texture, last);
    for (uint32_t channel = 0; channel < channels; channel++) {
        double mean = sums[channel] / width / height;
        if (fabs(last[channel] - mean) > 0.006 * (sample >= RASTER_HALF ? 16 : 1))
            fail_msg("channel %u of %ux%u: %g, and the mean is %g", channel, width, height,
                     last[channel], mean);
    }
    texture_release(&texture);
}

static void test_means(void **state)
{
    static const uint32_t sides[][2] = {{64, 64}, {37, 53}, {1, 9}, {200, 3}, {2, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++)
        for (uint32_t channels = 1; channels <= 4; channels++)
            for (int sample = RASTER_BYTE; sample <= RASTER_FLOAT; sample++) {
                expect_mean((enum raster_sample)sample, false, sides[i][0], sides[i][1], channels);
                if (sample < RASTER_HALF)
                    expect_mean((enum raster_sample)sample, true, sides[i][0], sides[i][1],
                                channels);
            }
}

static void test_large_floats(void **state)
{
    struct texture texture = texture_create(RASTER_FLOAT, false, 7, 5, 1);
    float *samples = texture.raster.samples;
    (void)state;
    for (int i = 0; i < 35; i++)
        samples[i] = i % 2 == 0 ? FLT_MAX : -FLT_MAX;
    samples[3] = samples[2] = samples[1] = FLT_MAX;
    add_levels(&texture);
    for (uint32_t level = 1; level < texture.level_count; level++)
        for (uint32_t i = 0; i < texture.levels[level].width * texture.levels[level].height; i++)
            assert_true(isfinite(((const float *)(const void *)texture.levels[level].bytes)[i]));
    texture_release(&texture);
}

/* Red to the left, blue to the right. */
static struct texture create_halves(void)
{
    struct texture texture = texture_create(RASTER_FLOAT, false, 16, 16, 3);
    for (int i = 0; i < 256; i++)
        ((float *)texture.raster.samples)[3 * i + (i % 16 < 8 ? 0 : 2)] = 1.0f;
    add_levels(&texture);
    return texture;
}

static void test_filter(void **state)
{
    struct texture texture = create_halves();
    float point[4], mean[4];
    (void)state;
    texture_sample(&texture, 0.22f, 0.4f, point);
    texture_filter(&texture, 0.22f, 0.4f, -INFINITY, mean);
    assert_memory_equal(point, mean, sizeof point);
    texture_filter(&texture, 0.22f, 0.4f, -4.0f, mean); /* a texel */
    assert_memory_equal(point, mean, sizeof point);
    for (int i = 0; i < 16; i++) {
        float wider[4], log_width = -4.0f + 0.25f * (float)i;
        texture_filter(&texture, 0.22f, 0.4f, log_width, mean);
        texture_filter(&texture, 0.22f, 0.4f, log_width + 0.25f, wider);
        assert_true(wider[0] <= mean[0]);
        assert_float_equal(mean[0] + mean[2], 1, 1e-6);
    }
    for (int i = 0; i < 10; i++) {
        texture_filter(&texture, 0.22f, 0.4f, 3.7f * (float)i, mean);
        assert_color(mean, 0.5f, 0, 0.5f, 1, 1e-6f);
    }
    texture_filter(&texture, NAN, INFINITY, -2.0f, mean);
    assert_true(isfinite(mean[0]));
    texture_filter(&texture, 0.22f, 0.4f, NAN, mean);
    assert_memory_equal(point, mean, sizeof point);
    texture.nearest = true;
    texture_filter(&texture, 0.22f, 0.4f, 0.0f, mean);
    assert_color(mean, 1, 0, 0, 1, 0);
    texture_release(&texture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_counts), cmocka_unit_test(test_colors_stay),
        cmocka_unit_test(test_means),        cmocka_unit_test(test_large_floats),
        cmocka_unit_test(test_filter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
