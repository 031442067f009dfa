#include "scene/mip_map.h"

#include "image/half.h"
#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t mip_map_half(uint32_t side)
{
    return side > 1 ? side / 2 : 1;
}

uint32_t mip_map_level_count(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    for (uint32_t side = width > height ? width : height; side > 1; side = mip_map_half(side))
        count++;
    return count;
}

/* --- encoding -------------------------------------------------------------------------------------- */

#define BINS 65536

/* The codes of numbers from 0 to 1, by a table of their values, which ascends. */
struct encoder {
    const float *value_of;
    uint32_t last;              /* code */
    uint16_t nearest[BINS + 1]; /* to the least number of each bin */
};

static void prepare(struct encoder *encoder, const float *value_of, uint32_t last)
{
    uint32_t code = 0;
    encoder->value_of = value_of;
    encoder->last = last;
    for (uint32_t bin = 0; bin <= BINS; bin++) {
        float value = (float)bin / (float)BINS;
        while (code < last && value_of[code + 1] - value < value - value_of[code])
            code++;
        encoder->nearest[bin] = (uint16_t)code;
    }
}

/* The code whose value is nearest; of two as near the even one, since means of few codes often lie halfway. */
static uint32_t encode(const struct encoder *encoder, float value)
{
    const float *value_of = encoder->value_of;
    uint32_t code = encoder->nearest[value < 1.0f ? (uint32_t)(value * (float)BINS) : BINS];
    float beyond = 0.0f; /* how much nearer the next one is */
    while (code < encoder->last &&
           (beyond = (value - value_of[code]) - (value_of[code + 1] - value)) > 0.0f)
        code++;
    return code + (code < encoder->last && beyond == 0.0f && code % 2 == 1);
}

/* --- halving --------------------------------------------------------------------------------------- */

/* What a texel covers of a row or column of the level before: two texels, or three, of which the outer ones in part. */
struct cover {
    uint32_t first, count;
    float weights[3];
};

static struct cover cover_of(uint32_t texel, uint32_t from, uint32_t to)
{
    struct cover cover = {.first = 0, .count = 1, .weights = {1.0f}};
    if (from == to)
        return cover;
    if (from % 2 == 0)
        return (struct cover){2 * texel, 2, {0.5f, 0.5f}};
    double scale = (double)from / to, start = texel * scale, end = start + scale;
    cover.first = 2 * texel;
    cover.count = 3;
    for (uint32_t i = 0; i < cover.count; i++) {
        double left = fmax(start, cover.first + i), right = fmin(end, cover.first + i + 1.0);
        cover.weights[i] = (float)((right - left) / scale);
    }
    return cover;
}

/* Two levels of a texture. */
struct halving {
    const struct texture *texture;
    const struct texels *from;
    struct texels to;
    unsigned char *bytes;                            /* of `to` */
    float *line;                                     /* room for a line of `from` as values */
    const struct encoder *color_codes, *alpha_codes; /* of bytes and shorts */
};

/* Adds samples of a line, times the weight; table_of: of each channel, or of all alike. */
#define ADD_CODES(type_)                                                                           \
    {                                                                                              \
        for (size_t i = 0; alike && i < count; i++)                                                \
            line[i] += weight * table_of[0][((const type_ *)at)[i]];                               \
        for (size_t i = 0; !alike && i < count; i++)                                               \
            line[i] += weight * table_of[i % channels][((const type_ *)at)[i]];                    \
    }

static void add_line(const struct halving *halving, uint32_t y, float weight)
{
    const struct texture *texture = halving->texture;
    uint32_t channels = texture->raster.channels;
    size_t count = (size_t)halving->from->width * channels;
    const void *at = halving->from->bytes + (size_t)y * halving->from->width * texture->texel_bytes;
    float *line = halving->line;
    const float *table_of[4];
    for (uint32_t i = 0; i < channels; i++)
        table_of[i] = i == texture_alpha(texture) ? texture->alpha_of : texture->color_of;
    bool alike = table_of[0] == table_of[channels - 1];
    if (!table_of[0]) /* floats */
        for (size_t i = 0; i < count; i++)
            line[i] += weight * ((const float *)at)[i];
    else if (texture->raster.sample == RASTER_BYTE)
        ADD_CODES(uint8_t)
    else
        ADD_CODES(uint16_t)
}

/* Sums of floats near the largest one may have left their range. */
static float within_floats(float value)
{
    if (value != value)
        return 0.0f;
    return fminf(fmaxf(value, -FLT_MAX), FLT_MAX);
}

static void store(const struct halving *halving, size_t sample, uint32_t channel, float value)
{
    const struct texture *texture = halving->texture;
    const struct encoder *codes =
        channel == texture_alpha(texture) ? halving->alpha_codes : halving->color_codes;
    void *samples = halving->bytes;
    switch (texture->raster.sample) {
    case RASTER_BYTE:
        ((uint8_t *)samples)[sample] = (uint8_t)encode(codes, value);
        break;
    case RASTER_SHORT:
        ((uint16_t *)samples)[sample] = (uint16_t)encode(codes, value);
        break;
    case RASTER_HALF:
        ((uint16_t *)samples)[sample] = half_from_float(value);
        break;
    case RASTER_FLOAT:
        ((float *)samples)[sample] = within_floats(value);
        break;
    }
}

static void store_line(const struct halving *halving, uint32_t y)
{
    uint32_t channels = halving->texture->raster.channels;
    for (uint32_t x = 0; x < halving->to.width; x++) {
        struct cover across = cover_of(x, halving->from->width, halving->to.width);
        const float *first = halving->line + (size_t)across.first * channels;
        size_t sample = ((size_t)y * halving->to.width + x) * channels;
        for (uint32_t channel = 0; channel < channels; channel++) {
            float mean = 0.0f;
            for (uint32_t i = 0; i < across.count; i++)
                mean += across.weights[i] * first[i * channels + channel];
            store(halving, sample + channel, channel, mean);
        }
    }
}

static void halve(const struct halving *halving)
{
    size_t values = (size_t)halving->from->width * halving->texture->raster.channels;
    for (uint32_t y = 0; y < halving->to.height; y++) {
        struct cover down = cover_of(y, halving->from->height, halving->to.height);
        memset(halving->line, 0, values * sizeof *halving->line);
        for (uint32_t i = 0; i < down.count; i++)
            add_line(halving, down.first + i, down.weights[i]);
        store_line(halving, y);
    }
}

/* --- all levels ------------------------------------------------------------------------------------ */

size_t mip_map_level_bytes(const struct texels *level, uint32_t tile_shift, uint32_t texel_bytes)
{
    uint32_t beyond = (1u << tile_shift) - 1;
    size_t across = (level->width + beyond) >> tile_shift;
    size_t down = (level->height + beyond) >> tile_shift;
    return (across * down << 2 * tile_shift) * texel_bytes;
}

size_t mip_map_place(struct texture *texture, uint32_t first, const unsigned char *bytes)
{
    uint32_t shift = texture->tile_shift, beyond = (1u << shift) - 1;
    uint32_t width = texture->levels[0].width, height = texture->levels[0].height;
    size_t sum = 0;
    for (uint32_t i = 0; i < texture->level_count; i++) {
        struct texels *level = &texture->levels[i];
        if (i >= first) {
            *level = (struct texels){width, height, (width + beyond) >> shift,
                                     bytes ? bytes + sum : NULL};
            sum += mip_map_level_bytes(level, shift, texture->texel_bytes);
        }
        width = mip_map_half(width);
        height = mip_map_half(height);
    }
    return sum;
}

static void fill_levels(struct texture *texture, float *line, struct encoder *color_codes,
                        struct encoder *alpha_codes)
{
    if (texture->color_of && texture->raster.sample != RASTER_HALF) {
        uint32_t last = texture->raster.sample == RASTER_BYTE ? UINT8_MAX : UINT16_MAX;
        prepare(color_codes, texture->color_of, last);
        if (texture->alpha_of == texture->color_of)
            alpha_codes = color_codes;
        else
            prepare(alpha_codes, texture->alpha_of, last);
    }
    unsigned char *bytes = texture->halves;
    for (uint32_t i = 1; i < texture->level_count; i++) {
        struct halving halving = {.texture = texture,
                                  .from = &texture->levels[i - 1],
                                  .to = texture->levels[i],
                                  .bytes = bytes,
                                  .line = line,
                                  .color_codes = color_codes,
                                  .alpha_codes = alpha_codes};
        halve(&halving);
        bytes += mip_map_level_bytes(&halving.to, 0, texture->texel_bytes);
    }
}

ps_result mip_map_add(struct texture *texture, struct error *error)
{
    assert(texture->level_count == 1 && texture->tile_shift == 0 && !texture->halves);
    struct encoder *codes = malloc(2 * sizeof *codes);
    float *line = malloc((size_t)texture->width * 4 * sizeof *line);
    texture->level_count = mip_map_level_count(texture->width, texture->height);
    size_t bytes = mip_map_place(texture, 1, NULL);
    texture->halves = malloc(bytes + 1);
    bool is_there = codes && line && texture->halves;
    if (is_there) {
        mip_map_place(texture, 1, texture->halves);
        fill_levels(texture, line, &codes[0], &codes[1]);
    } else {
        free(texture->halves);
        texture->halves = NULL;
        texture->level_count = 1;
    }
    free(line);
    free(codes);
    return is_there ? PS_OK : error_memory(error, bytes, "a texture's MIP map");
}
