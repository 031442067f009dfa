/* texture_fixture.h: textures from tests/data, from bytes, and made by hand. */
#ifndef TESTS_TEXTURE_FIXTURE_H
#define TESTS_TEXTURE_FIXTURE_H

#include "image/half.h"
#include "image/tonemap.h"
#include "scene/texture.h"
#include "scratch.h"

#include <math.h>

/* tests/data/NAME; valid until the next call. */
static inline const char *data_path(const char *name)
{
    static char path[1024];
    const char *source = getenv("PSPLAT_SOURCE");
    snprintf(path, sizeof path, "%s/tests/data/%s", source ? source : ".", name);
    return path;
}

static inline struct texture load_data(const char *name, enum texture_encoding encoding)
{
    struct texture_description description = {
        .path = (char *)data_path(name), .encoding = encoding, .nearest = true};
    struct texture texture = {0};
    struct error error = {{0}};
    if (texture_load(&description, NULL, &texture, &error) != PS_OK) {
        fail_msg("%s", error.text);
    }
    return texture;
}

static inline ps_result load_bytes(const unsigned char *bytes, size_t size, struct texture *texture,
                                   struct error *error)
{
    struct texture_description description = {
        .path = "some.picture", .bytes = (unsigned char *)bytes, .byte_count = size};
    *error = (struct error){{0}};
    *texture = (struct texture){0};
    ps_result result = texture_load(&description, NULL, texture, error);
    if (result != PS_OK) {
        assert_null(texture->raster.samples);
        assert_int_equal(strncmp(error->text, "some.picture: ", 14), 0);
    }
    return result;
}

/* Of floats, which stay the caller's: top row first, never to be released. */
static inline struct texture texture_of(float *samples, uint32_t width, uint32_t height,
                                        uint32_t channels)
{
    return (struct texture){.width = width,
                            .height = height,
                            .texel_bytes = channels * (uint32_t)sizeof *samples,
                            .levels = {{width, height, width, (const unsigned char *)samples}},
                            .level_count = 1,
                            .raster = {.width = width,
                                       .height = height,
                                       .channels = channels,
                                       .sample = RASTER_FLOAT,
                                       .samples = samples}};
}

/* Owns a picture in which all numbers are 0, with tables as a loaded one has them. */
static inline struct texture texture_create(enum raster_sample sample, bool srgb, uint32_t width,
                                            uint32_t height, uint32_t channels)
{
    size_t count = (size_t)width * height * channels;
    uint32_t codes = sample == RASTER_BYTE ? UINT8_MAX + 1 : UINT16_MAX + 1;
    struct texture texture = texture_of(calloc(count, sizeof(float)), width, height, channels);
    texture.raster.sample = sample;
    texture.texel_bytes = raster_texel_bytes(&texture.raster);
    texture.srgb = srgb;
    texture.log_side = 0.5f * log2f((float)width * (float)height);
    if (sample == RASTER_FLOAT)
        return texture;
    texture.color_of = malloc(codes * sizeof(float));
    texture.alpha_of = srgb ? malloc(codes * sizeof(float)) : texture.color_of;
    for (uint32_t code = 0; code < codes; code++) {
        double value = (double)code / (codes - 1);
        texture.alpha_of[code] =
            sample == RASTER_HALF ? half_to_float((uint16_t)code) : (float)value;
        if (srgb)
            texture.color_of[code] = (float)tonemap_linear(value);
    }
    return texture;
}

static inline void assert_color(const float rgba[4], float r, float g, float b, float a,
                                float tolerance)
{
    const float expected[4] = {r, g, b, a};
    for (int i = 0; i < 4; i++) {
        if (!(fabsf(rgba[i] - expected[i]) <= tolerance)) {
            fail_msg("(%g, %g, %g, %g) is not (%g, %g, %g, %g)", rgba[0], rgba[1], rgba[2], rgba[3],
                     r, g, b, a);
        }
    }
}

#endif
