#include "scene/mip_map_stream.h"

#include "image/half.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- encoding
 * -------------------------------------------------------------------------------------- */

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

/* The code whose value is nearest; of two as near the even one, since means of few codes often lie
 * halfway. */
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

/* --- halving
 * --------------------------------------------------------------------------------------- */

/* What a texel covers of a row or column of the level before: two texels, or three, of which the
 * outer ones in part. */
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

/* What is known of the next lines of a level: sums over those of the level before, whose width they
 * have, and room for a line that is done. Two lines at most share one of the level before. */
struct coming {
    float *sums[2];
    void *samples;
};

struct mip_map_stream {
    const struct texture *texture;
    mip_map_take take;
    void *user;
    struct encoder color_codes, alpha_codes; /* of bytes and shorts */
    struct coming levels[TEXTURE_LEVELS];    /* but the first */
    uint32_t next[TEXTURE_LEVELS];           /* line */
    float *sums;                             /* owned: of all levels */
    unsigned char *samples;                  /* owned */
};

/* Adds samples of a line, times the weight; table_of: of each channel, or of all alike. */
#define ADD_CODES(type_)                                                                           \
    {                                                                                              \
        for (size_t i = 0; alike && i < count; i++)                                                \
            sums[i] += weight * table_of[0][((const type_ *)samples)[i]];                          \
        for (size_t i = 0; !alike && i < count; i++)                                               \
            sums[i] += weight * table_of[i % channels][((const type_ *)samples)[i]];               \
    }

static void add_samples(const struct texture *texture, const void *samples, uint32_t width,
                        float weight, float *sums)
{
    uint32_t channels = texture->raster.channels;
    size_t count = (size_t)width * channels;
    const float *table_of[4];
    for (uint32_t i = 0; i < 4; i++)
        table_of[i] = i == texture_alpha(texture) ? texture->alpha_of : texture->color_of;
    bool alike = texture->alpha_of == texture->color_of || texture_alpha(texture) >= channels;
    if (!texture->color_of) /* floats */
        for (size_t i = 0; i < count; i++)
            sums[i] += weight * ((const float *)samples)[i];
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

static void store(const struct mip_map_stream *stream, void *samples, size_t sample,
                  uint32_t channel, float value)
{
    const struct texture *texture = stream->texture;
    bool is_alpha = channel == texture_alpha(texture) && texture->alpha_of != texture->color_of;
    const struct encoder *codes = is_alpha ? &stream->alpha_codes : &stream->color_codes;
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

/* From the sums of a line of that level. */
static void store_line(const struct mip_map_stream *stream, uint32_t level, const float *sums,
                       void *samples)
{
    const struct texels *levels = stream->texture->levels;
    uint32_t channels = stream->texture->raster.channels;
    for (uint32_t x = 0; x < levels[level].width; x++) {
        struct cover across = cover_of(x, levels[level - 1].width, levels[level].width);
        const float *first = sums + (size_t)across.first * channels;
        for (uint32_t channel = 0; channel < channels; channel++) {
            float mean = 0.0f;
            for (uint32_t i = 0; i < across.count; i++)
                mean += across.weights[i] * first[i * channels + channel];
            store(stream, samples, (size_t)x * channels + channel, channel, mean);
        }
    }
}

static ps_result add_to_level(struct mip_map_stream *stream, uint32_t level, const void *samples,
                              struct error *error);

/* What a line of the level before has of a line of this level, if anything. */
static ps_result add_to_line(struct mip_map_stream *stream, uint32_t level, uint32_t line,
                             uint32_t before, const void *samples, struct error *error)
{
    const struct texture *texture = stream->texture;
    const struct texels *from = &texture->levels[level - 1];
    struct cover down = cover_of(line, from->height, texture->levels[level].height);
    float *sums = stream->levels[level].sums[line % 2];
    if (before < down.first || before >= down.first + down.count)
        return PS_OK;
    if (before == down.first)
        memset(sums, 0, (size_t)from->width * texture->raster.channels * sizeof *sums);
    add_samples(texture, samples, from->width, down.weights[before - down.first], sums);
    if (before < down.first + down.count - 1)
        return PS_OK;
    store_line(stream, level, sums, stream->levels[level].samples);
    return add_to_level(stream, level, stream->levels[level].samples, error);
}

static ps_result add_to_level(struct mip_map_stream *stream, uint32_t level, const void *samples,
                              struct error *error)
{
    const struct texture *texture = stream->texture;
    uint32_t line = stream->next[level]++;
    ps_result result = stream->take(stream->user, level, line, samples, error);
    if (level + 1 == texture->level_count)
        return result;
    uint32_t height = texture->levels[level + 1].height, last = line / 2;
    for (uint32_t next = last > 0 ? last - 1 : 0; next <= last && next < height; next++)
        if (result == PS_OK)
            result = add_to_line(stream, level + 1, next, line, samples, error);
    return result;
}

/* --- the stream --- */

/* Of the sums and of the samples of all levels but the first. */
static void place_lines(struct mip_map_stream *stream)
{
    const struct texture *texture = stream->texture;
    float *sums = stream->sums;
    unsigned char *samples = stream->samples;
    for (uint32_t i = 1; i < texture->level_count; i++) {
        struct coming *coming = &stream->levels[i];
        for (int k = 0; k < 2; k++, sums += texture->levels[i - 1].width * texture->raster.channels)
            coming->sums[k] = sums;
        coming->samples = samples;
        samples += (texture->levels[i].width * texture->texel_bytes + 3) / 4 * 4;
    }
}

static void prepare_codes(struct mip_map_stream *stream)
{
    const struct texture *texture = stream->texture;
    uint32_t last = texture->raster.sample == RASTER_BYTE ? UINT8_MAX : UINT16_MAX;
    if (!texture->color_of || texture->raster.sample == RASTER_HALF || texture->level_count == 1)
        return;
    prepare(&stream->color_codes, texture->color_of, last);
    if (texture->alpha_of != texture->color_of)
        prepare(&stream->alpha_codes, texture->alpha_of, last);
}

struct mip_map_stream *mip_map_open(const struct texture *texture, mip_map_take take, void *user,
                                    struct error *error)
{
    size_t sums = 1, samples = 1;
    for (uint32_t i = 1; i < texture->level_count; i++) {
        sums += (size_t)2 * texture->levels[i - 1].width * texture->raster.channels;
        samples += (size_t)texture->levels[i].width * texture->texel_bytes + 3;
    }
    struct mip_map_stream *stream = malloc(sizeof *stream);
    if (stream)
        *stream = (struct mip_map_stream){.texture = texture,
                                          .take = take,
                                          .user = user,
                                          .sums = malloc(sums * sizeof *stream->sums),
                                          .samples = malloc(samples)};
    if (!stream || !stream->sums || !stream->samples) {
        error_memory(error, sums * sizeof *stream->sums + samples, "a texture's MIP map");
        mip_map_close(stream);
        return NULL;
    }
    place_lines(stream);
    prepare_codes(stream);
    return stream;
}

ps_result mip_map_add_line(struct mip_map_stream *stream, const void *samples, struct error *error)
{
    return add_to_level(stream, 0, samples, error);
}

void mip_map_close(struct mip_map_stream *stream)
{
    if (stream) {
        free(stream->sums);
        free(stream->samples);
    }
    free(stream);
}
