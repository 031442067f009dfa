/* texture.c: wrapping and interpolation.
 *
 * A coordinate is wrapped into 0..1 first, while it still is a fraction of the picture, so that
 * texel numbers are small whatever comes in. Repeating also wraps the second texel of an
 * interpolated pair; a clamped or mirrored picture has the same texel again beyond its edge.
 */
#include "scene/texture.h"

#include "image/tonemap.h"
#include "scene/fraction.h"

#include <float.h>
#include <math.h>

/* --- looking up ------------------------------------------------------------------------------ */

/* Where the samples of a level's texel lie: by rows from the top. */
static const void *texel_at(const struct texture *texture, const struct texels *level,
                            uint32_t column, uint32_t line)
{
    uint32_t shift = texture->tile_shift, mask = (1u << shift) - 1;
    size_t tile = (size_t)(line >> shift) * level->tiles_across + (column >> shift);
    size_t within = (size_t)(line & mask) << shift | (column & mask);
    const unsigned char *at = level->bytes + ((tile << 2 * shift) + within) * texture->texel_bytes;
    if (texture->file)
        mapped_file_touch(texture->file, at, texture->texel_bytes);
    return at;
}

static float decode_float(float display)
{
    double linear = tonemap_linear(display);
    return (float)fmax(-FLT_MAX, fmin(linear, FLT_MAX));
}

void texture_values(const struct texture *texture, const void *samples, float values[4])
{
    uint32_t channels = texture->raster.channels, alpha = texture_alpha(texture);
    for (uint32_t channel = 0; channel < channels; channel++) {
        const float *value_of = channel == alpha ? texture->alpha_of : texture->color_of;
        switch (texture->raster.sample) {
        case RASTER_BYTE:
            values[channel] = value_of[((const uint8_t *)samples)[channel]];
            break;
        case RASTER_SHORT:
        case RASTER_HALF:
            values[channel] = value_of[((const uint16_t *)samples)[channel]];
            break;
        case RASTER_FLOAT:
            values[channel] = ((const float *)samples)[channel];
            if (texture->srgb && channel != alpha)
                values[channel] = decode_float(values[channel]);
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

static void read_texel(const struct texture *texture, const struct texels *level, uint32_t column,
                       uint32_t row, float rgba[4])
{
    uint32_t channels = texture->raster.channels;
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 1.0f;
    texture_values(texture, texel_at(texture, level, column, level->height - 1 - row), rgba);
    if (channels < 3)
        spread_grey(channels, rgba);
}

void texture_texel(const struct texture *texture, uint32_t column, uint32_t row, float rgba[4])
{
    read_texel(texture, &texture->levels[0], column, row, rgba);
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

static void interpolate(const struct texture *texture, const struct texels *level, float u, float v,
                        float rgba[4])
{
    struct neighbors across = find_neighbors(u, level->width, texture->wrap_u);
    struct neighbors up = find_neighbors(v, level->height, texture->wrap_v);
    float corners[4][4];
    read_texel(texture, level, across.first, up.first, corners[0]);
    read_texel(texture, level, across.second, up.first, corners[1]);
    read_texel(texture, level, across.first, up.second, corners[2]);
    read_texel(texture, level, across.second, up.second, corners[3]);
    for (int i = 0; i < 4; i++) {
        float low = mix(corners[0][i], corners[1][i], across.share);
        float high = mix(corners[2][i], corners[3][i], across.share);
        rgba[i] = mix(low, high, up.share);
    }
}

void texture_sample(const struct texture *texture, float u, float v, float rgba[4])
{
    if (texture->nearest)
        texture_texel(texture, find_nearest(u, texture->width, texture->wrap_u),
                      find_nearest(v, texture->height, texture->wrap_v), rgba);
    else
        interpolate(texture, &texture->levels[0], u, v, rgba);
}

void texture_filter(const struct texture *texture, float u, float v, float log_width, float rgba[4])
{
    float place = log_width + texture->log_side, last = (float)(texture->level_count - 1);
    if (!(place > 0.0f) || texture->nearest || texture->level_count == 1) {
        texture_sample(texture, u, v, rgba);
        return;
    }
    place = fminf(place, last);
    uint32_t level = (uint32_t)place;
    float share = place - (float)level;
    interpolate(texture, &texture->levels[level], u, v, rgba);
    if (share > 0.0f) {
        float coarser[4];
        interpolate(texture, &texture->levels[level + 1], u, v, coarser);
        for (int i = 0; i < 4; i++)
            rgba[i] = mix(rgba[i], coarser[i], share);
    }
}
