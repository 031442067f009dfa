/* raster_stb.c: TGA, BMP and Radiance HDR pictures, through stb_image.
 *
 * stb_image goes on with zeros, or with memory that nobody wrote, where a file ends too early. So
 * it reads through callbacks here, which see whether it asks for more than there is; such a picture
 * is refused. It fills its own small buffer with what there is, be that less than the buffer holds,
 * and everything else it asks for it needs whole; its first read is into that buffer, by whose
 * address the two are told apart. Beyond the end it is given newlines: of zeros Radiance's reader
 * would take runs of length 0 for ever.
 *
 * Radiance: 32 bits of mantissas and exponent, plain or in runs, top line first (raster_radiance.c
 * has the rest); EXPOSURE and PRIMARIES are not looked at. stb_image knows neither the runs of
 * before 1991 nor XYZE.
 */
#include "image/raster_decode.h"

#ifdef PSPLAT_STB
#include <stb_image.h>
#include <string.h>

/* The most that comes out of one byte: of two bytes in a run of TGA's 128 pixels that are indices
 * of colours with alpha, 512; runs of Radiance reach 190. */
#define EXPANSION 256

struct reading {
    const struct raster_source *source;
    size_t position;
    const char *buffer; /* stb_image's own; NULL before the first read */
    bool beyond;        /* more was wanted than there is */
};

static int read_bytes(void *user, char *bytes, int size)
{
    struct reading *reading = user;
    size_t left = reading->source->size - reading->position;
    size_t count = (size_t)size < left ? (size_t)size : left;
    if (!reading->buffer)
        reading->buffer = bytes;
    reading->beyond |= count == 0 || (bytes != reading->buffer && count < (size_t)size);
    memcpy(bytes, reading->source->bytes + reading->position, count);
    reading->position += count;
    if (count > 0 || bytes != reading->buffer)
        return (int)count;
    memset(bytes, '\n', (size_t)size); /* ends headers, and counts as runs of some length */
    return size;
}

static void skip_bytes(void *user, int count)
{
    struct reading *reading = user;
    size_t left = reading->source->size - reading->position;
    if (count < 0) {
        size_t back = (size_t) - (int64_t)count;
        reading->position -= back < reading->position ? back : reading->position;
        return;
    }
    reading->beyond |= (size_t)count > left;
    reading->position += (size_t)count < left ? (size_t)count : left;
}

static int is_at_end(void *user)
{
    const struct reading *reading = user;
    return reading->position == reading->source->size;
}

static const stbi_io_callbacks callbacks = {read_bytes, skip_bytes, is_at_end};

static ps_result end_too_early(const struct raster_source *source, struct error *error)
{
    return error_set(error, PS_ERROR_IO, "%s: it ends too early (a truncated picture)",
                     source->path);
}

/* By a byte that is 0 or 1 in a TGA, '?' in a Radiance file. */
static bool is_bmp(const struct raster_source *source)
{
    return source->bytes[1] == 'M';
}

static ps_result explain(const struct reading *reading, struct error *error)
{
    const char *reason = stbi_failure_reason();
    const struct raster_source *source = reading->source;
    if (reading->beyond)
        return end_too_early(source, error);
    if (reason && strcmp(reason, "outofmem") == 0)
        return error_set(error, PS_ERROR_MEMORY, "%s: out of memory for its pixels", source->path);
    if (is_bmp(source))
        return error_set(error, PS_ERROR_INVALID, "%s: a BMP of a kind that cannot be read",
                         source->path);
    if (source->bytes[1] == '?')
        return error_set(error, PS_ERROR_INVALID,
                         "%s: a Radiance file of a kind that cannot be read, as of XYZE",
                         source->path);
    return error_set(error, PS_ERROR_INVALID, "%s: this kind of picture cannot be read: %s",
                     source->path, reason ? reason : "unknown");
}

static ps_result read_size(const struct raster_source *source, size_t sample_bytes,
                           struct error *error)
{
    struct reading reading = {.source = source};
    int width, height, channels;
    if (!stbi_info_from_callbacks(&callbacks, &reading, &width, &height, &channels))
        return explain(&reading, error);
    size_t pixel_bytes = (size_t)channels * sample_bytes;
    ps_result result = raster_check_size(source->path, width, height, pixel_bytes, error);
    if (result != PS_OK)
        return result;
    return raster_check_expansion(source, (uint64_t)width * (uint64_t)height * pixel_bytes,
                                  EXPANSION, error);
}

/* Some programs leave 0 in the byte that would be alpha, and say in the header that it is none;
 * others say so of one that counts. */
static void mend_alpha(const struct raster_source *source, struct raster *raster)
{
    unsigned char *samples = raster->samples;
    size_t pixels = (size_t)raster->width * raster->height;
    if (is_bmp(source) || /* where stb_image does the same */
        raster->channels != 4 || (source->bytes[17] & 15) != 0)
        return;
    for (size_t i = 0; i < pixels; i++)
        if (samples[4 * i + 3] != 0)
            return;
    for (size_t i = 0; i < pixels; i++)
        samples[4 * i + 3] = 255;
}

static ps_result read_samples(const struct raster_source *source, bool floats,
                              struct raster *raster, struct error *error)
{
    struct reading reading = {.source = source};
    int width, height, channels;
    raster->samples =
        floats
            ? (void *)stbi_loadf_from_callbacks(&callbacks, &reading, &width, &height, &channels, 0)
            : stbi_load_from_callbacks(&callbacks, &reading, &width, &height, &channels, 0);
    if (!raster->samples)
        return explain(&reading, error);
    if (reading.beyond)
        return end_too_early(source, error);
    raster->width = (uint32_t)width;
    raster->height = (uint32_t)height;
    raster->channels = (uint32_t)channels;
    raster->sample = floats ? RASTER_FLOAT : RASTER_BYTE;
    raster->srgb = !floats;
    return PS_OK;
}

ps_result raster_read_bytes(const struct raster_source *source, struct raster *raster,
                            struct error *error)
{
    ps_result result = read_size(source, 1, error);
    if (result == PS_OK)
        result = read_samples(source, false, raster, error);
    if (result == PS_OK)
        mend_alpha(source, raster);
    return result;
}

ps_result raster_read_floats(const struct raster_source *source, struct raster *raster,
                             struct error *error)
{
    ps_result result = read_size(source, sizeof(float), error);
    return result == PS_OK ? read_samples(source, true, raster, error) : result;
}

#endif
