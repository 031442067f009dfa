/* texture.c: loading, wrapping and interpolation.
 *
 * A coordinate is wrapped into 0..1 first, while it still is a fraction of the picture, so that
 * texel numbers are small whatever comes in. Repeating also wraps the second texel of an
 * interpolated pair; a clamped or mirrored picture has the same texel again beyond its edge.
 */
#include "scene/texture.h"

#include "image/half.h"
#include "image/tonemap.h"
#include "scene/fraction.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* --- loading --------------------------------------------------------------------------------- */

static size_t code_count(enum raster_sample sample)
{
    return sample == RASTER_BYTE ? UINT8_MAX + 1 : UINT16_MAX + 1;
}

static double code_value(enum raster_sample sample, size_t code)
{
    if (sample == RASTER_HALF)
        return half_to_float((uint16_t)code);
    return (double)code / (double)(code_count(sample) - 1);
}

static float *create_table(enum raster_sample sample, bool srgb)
{
    size_t count = code_count(sample);
    float *table = malloc(count * sizeof *table);
    for (size_t code = 0; table && code < count; code++) {
        double value = code_value(sample, code);
        table[code] = (float)(srgb ? tonemap_linear(value) : value);
    }
    return table;
}

static bool has_alpha(const struct raster *raster)
{
    return raster->channels == 2 || raster->channels == 4;
}

/* Alpha has a table of its own only where it is decoded otherwise than colours are. */
static bool create_tables(struct texture *texture, bool srgb)
{
    enum raster_sample sample = texture->raster.sample;
    texture->color_of = create_table(sample, srgb);
    texture->alpha_of =
        srgb && has_alpha(&texture->raster) ? create_table(sample, false) : texture->color_of;
    return texture->color_of && texture->alpha_of;
}

static float decode_float(float display)
{
    double linear = tonemap_linear(display);
    return (float)fmax(-FLT_MAX, fmin(linear, FLT_MAX));
}

static void decode_floats(const struct raster *raster)
{
    float *samples = raster->samples;
    size_t pixels = (size_t)raster->width * raster->height;
    uint32_t colors = raster->channels - has_alpha(raster);
    for (size_t i = 0; i < pixels; i++)
        for (uint32_t channel = 0; channel < colors; channel++) {
            float *sample = &samples[i * raster->channels + channel];
            *sample = decode_float(*sample);
        }
}

static ps_result prepare_values(struct texture *texture, const char *path, bool srgb,
                                struct error *error)
{
    if (texture->raster.sample == RASTER_FLOAT) {
        if (srgb)
            decode_floats(&texture->raster);
        return PS_OK;
    }
    if (!create_tables(texture, srgb))
        return error_set(error, PS_ERROR_MEMORY, "%s: out of memory for a table of colours", path);
    return PS_OK;
}

ps_result texture_load(const struct texture_description *description, const char *folder,
                       struct texture *texture, struct error *error)
{
    struct texture loaded = {.wrap_u = description->wrap_u,
                             .wrap_v = description->wrap_v,
                             .nearest = description->nearest};
    ps_result result =
        description->bytes
            ? raster_decode(description->path, description->layer, description->bytes,
                            description->byte_count, &loaded.raster, error)
            : raster_read(description->path, description->layer, folder, &loaded.raster, error);
    if (result != PS_OK)
        return result;
    bool srgb = description->encoding == ENCODING_SRGB ||
                (description->encoding == ENCODING_AUTO && loaded.raster.srgb);
    loaded.width = loaded.raster.width;
    loaded.height = loaded.raster.height;
    result = prepare_values(&loaded, description->path, srgb, error);
    if (result != PS_OK) {
        texture_release(&loaded);
        return result;
    }
    *texture = loaded;
    return PS_OK;
}

void texture_release(struct texture *texture)
{
    if (texture->alpha_of != texture->color_of)
        free(texture->alpha_of);
    free(texture->color_of);
    raster_release(&texture->raster);
    *texture = (struct texture){0};
}

size_t texture_bytes(const struct texture *texture)
{
    size_t tables = 0;
    if (texture->color_of) {
        size_t count = texture->alpha_of == texture->color_of ? 1 : 2;
        tables = count * code_count(texture->raster.sample) * sizeof(float);
    }
    return raster_bytes(&texture->raster) + tables;
}

/* --- looking up ------------------------------------------------------------------------------ */

/* All channels of one texel as values; `alpha` is the number of the one that is alpha. */
static void read_values(const struct texture *texture, size_t first, uint32_t alpha,
                        float values[4])
{
    uint32_t channels = texture->raster.channels;
    const void *samples = texture->raster.samples;
    for (uint32_t channel = 0; channel < channels; channel++) {
        const float *value_of = channel == alpha ? texture->alpha_of : texture->color_of;
        size_t i = first + channel;
        switch (texture->raster.sample) {
        case RASTER_BYTE:
            values[channel] = value_of[((const uint8_t *)samples)[i]];
            break;
        case RASTER_SHORT:
        case RASTER_HALF:
            values[channel] = value_of[((const uint16_t *)samples)[i]];
            break;
        case RASTER_FLOAT:
            values[channel] = ((const float *)samples)[i];
            break;
        }
    }
}

/* Grey stands for three equal colours. */
static void spread_grey(uint32_t channels, float rgba[4])
{
    rgba[3] = channels == 2 ? rgba[1] : 1.0f;
    rgba[1] = rgba[2] = rgba[0];
}

void texture_texel(const struct texture *texture, uint32_t column, uint32_t row, float rgba[4])
{
    uint32_t channels = texture->raster.channels;
    size_t line = texture->height - 1 - row;
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 1.0f;
    read_values(texture, (line * texture->width + column) * channels, channels < 3 ? 1 : 3, rgba);
    if (channels < 3)
        spread_grey(channels, rgba);
}

/* Into 0..1, as the wrapping says. */
static float wrap_coordinate(float coordinate, int32_t wrap)
{
    if (wrap == WRAP_REPEAT)
        return fraction_of(coordinate);
    if (wrap == WRAP_MIRROR) {
        float folded = 2.0f * fraction_of(0.5f * coordinate);
        return folded > 1.0f ? 2.0f - folded : folded;
    }
    float raised = coordinate > 0.0f ? coordinate : 0.0f; /* NaN too */
    return raised < 1.0f ? raised : 1.0f;
}

/* Two neighbours along one axis, and the share of the second. */
struct neighbors {
    uint32_t first, second;
    float share;
};

static struct neighbors find_neighbors(float coordinate, uint32_t size, int32_t wrap)
{
    float place = wrap_coordinate(coordinate, wrap) * (float)size + 0.5f; /* texel i at i + 1 */
    uint32_t next = (uint32_t)place;                                      /* 0 to size */
    bool repeats = wrap == WRAP_REPEAT;
    struct neighbors neighbors = {.share = place - (float)next};
    neighbors.first = next > 0 ? next - 1 : (repeats ? size - 1 : 0);
    neighbors.second = next < size ? next : (repeats ? 0 : size - 1);
    return neighbors;
}

static uint32_t find_nearest(float coordinate, uint32_t size, int32_t wrap)
{
    uint32_t texel = (uint32_t)(wrap_coordinate(coordinate, wrap) * (float)size);
    return texel < size ? texel : size - 1;
}

/* In this form no difference of large floats overflows. */
static float mix(float a, float b, float share)
{
    return (1.0f - share) * a + share * b;
}

static void interpolate(const struct texture *texture, struct neighbors across, struct neighbors up,
                        float rgba[4])
{
    float corners[4][4];
    texture_texel(texture, across.first, up.first, corners[0]);
    texture_texel(texture, across.second, up.first, corners[1]);
    texture_texel(texture, across.first, up.second, corners[2]);
    texture_texel(texture, across.second, up.second, corners[3]);
    for (int i = 0; i < 4; i++) {
        float low = mix(corners[0][i], corners[1][i], across.share);
        float high = mix(corners[2][i], corners[3][i], across.share);
        rgba[i] = mix(low, high, up.share);
    }
}

void texture_sample(const struct texture *texture, float u, float v, float rgba[4])
{
    if (texture->nearest) {
        texture_texel(texture, find_nearest(u, texture->width, texture->wrap_u),
                      find_nearest(v, texture->height, texture->wrap_v), rgba);
        return;
    }
    interpolate(texture, find_neighbors(u, texture->width, texture->wrap_u),
                find_neighbors(v, texture->height, texture->wrap_v), rgba);
}

/* --- range ----------------------------------------------------------------------------------- */

static bool is_within(const float rgba[4], float factor)
{
    for (int k = 0; k < 3; k++)
        if (rgba[k] < 0.0f || rgba[k] * factor > 1.0f)
            return false;
    return true;
}

bool texture_leaves_range(struct texture *texture, float factor)
{
    const struct raster *raster = &texture->raster;
    if (raster->sample == RASTER_BYTE || raster->sample == RASTER_SHORT)
        return factor > 1.0f;
    if (factor <= texture->checked)
        return false;
    for (uint32_t row = 0; row < texture->height; row++)
        for (uint32_t column = 0; column < texture->width; column++) {
            float rgba[4];
            texture_texel(texture, column, row, rgba);
            if (!is_within(rgba, factor))
                return true;
        }
    texture->checked = factor;
    return false;
}
