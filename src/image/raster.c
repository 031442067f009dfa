/* raster.c: fetches a picture's bytes, sees what they are, and has them decoded. */
#include "image/raster_decode.h"

#include "base/input_file.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef ps_result (*raster_reader)(const struct raster_source *source, struct raster *raster,
                                   struct error *error);

/* By `length` bytes at `offset`. `read` is NULL for what is not read, in this build or at all. */
static const struct format {
    const char *name, *magic;
    size_t offset, length;
    raster_reader read;
} formats[] = {
    {"PNG", "\x89PNG\r\n\x1a\n", 0, 8, raster_read_png},
    {"JPEG", "\xff\xd8\xff", 0, 3, raster_read_jpeg},
    {"OpenEXR", "\x76\x2f\x31\x01", 0, 4, raster_read_exr},
#ifdef PSPLAT_STB
    {"BMP", "BM", 0, 2, raster_read_bytes},
    {"Radiance HDR", "#?", 0, 2, raster_read_radiance},
#else
    {"BMP", "BM", 0, 2, NULL},
    {"Radiance HDR", "#?", 0, 2, NULL},
#endif
#ifdef PSPLAT_WEBP
    {"WebP", "WEBP", 8, 4, raster_read_webp},
#else
    {"WebP", "WEBP", 8, 4, NULL},
#endif
    {"KTX2", "\xabKTX 20\xbb", 0, 8, NULL},
    {"DDS", "DDS ", 0, 4, NULL},
    {"GIF", "GIF8", 0, 4, NULL},
    {"TIFF", "II*", 0, 4, NULL},
    {"TIFF", "MM\0*", 0, 4, NULL},
    {"PSD", "8BPS", 0, 4, NULL},
};

#define BMP_COMPRESSION 30 /* where it stands: 1 and 2 are runs of 8 and of 4 bits */
#define TARGA_HEADER 18

#define FORMAT_COUNT (sizeof formats / sizeof *formats)

/* Not read, in any build. */
static const struct format bmp_in_runs = {.name = "BMP in runs"};

static const struct format targa = {
    .name = "TGA",
#ifdef PSPLAT_STB
    .read = raster_read_bytes,
#endif
};

const char raster_kinds[] = "PNG, JPEG, OpenEXR"
#ifdef PSPLAT_STB
                            ", TGA, BMP, Radiance HDR"
#endif
#ifdef PSPLAT_WEBP
                            ", WebP"
#endif
    ;

uint32_t raster_texel_bytes(const struct raster *raster)
{
    static const uint32_t sizes[] = {
        [RASTER_BYTE] = 1, [RASTER_SHORT] = 2, [RASTER_HALF] = 2, [RASTER_FLOAT] = 4};
    return raster->channels * sizes[raster->sample];
}

size_t raster_bytes(const struct raster *raster)
{
    return (size_t)raster->width * raster->height * raster_texel_bytes(raster);
}

void *raster_row(const struct raster *raster, size_t row)
{
    return (unsigned char *)raster->samples + row * raster->width * raster_texel_bytes(raster);
}

void raster_release(struct raster *raster)
{
    free(raster->samples);
    *raster = (struct raster){0};
}

ps_result raster_check_size(const char *path, int64_t width, int64_t height, size_t pixel_bytes,
                            struct error *error)
{
    if (width <= 0 || height <= 0) {
        return error_set(error, PS_ERROR_INVALID, "%s: a picture of %lld x %lld pixels cannot be",
                         path, (long long)width, (long long)height);
    }
    if (width > RASTER_SIDE_LIMIT || height > RASTER_SIDE_LIMIT ||
        (uint64_t)width * (uint64_t)height > RASTER_PIXEL_LIMIT) {
        double gibibytes = (double)width * (double)height * (double)pixel_bytes * 0x1p-30;
        return error_set(error, PS_ERROR_INVALID,
                         "%s: %lld x %lld pixels (%.3g GiB of memory) are beyond the limit of %d a "
                         "side and 2^30 in all",
                         path, (long long)width, (long long)height, gibibytes, RASTER_SIDE_LIMIT);
    }
    return PS_OK;
}

ps_result raster_check_expansion(const struct raster_source *source, uint64_t decoded,
                                 uint64_t expansion, struct error *error)
{
    if (decoded / expansion <= source->size)
        return PS_OK;
    return error_set(error, PS_ERROR_IO,
                     "%s: it ends too early: %zu bytes cannot hold the picture that it states",
                     source->path, source->size);
}

/* NULL with a message. */
static void *allocate(const char *path, const struct raster *raster, size_t bytes,
                      struct error *error)
{
    void *samples = malloc(bytes);
    if (!samples)
        error_set(error, PS_ERROR_MEMORY, "%s: out of memory: wanted %zu bytes for %u x %u pixels",
                  path, bytes, raster->width, raster->height);
    return samples;
}

ps_result raster_allocate(const char *path, struct raster *raster, struct error *error)
{
    ps_result result =
        raster_check_size(path, raster->width, raster->height, raster_texel_bytes(raster), error);
    if (result != PS_OK)
        return result;
    raster->samples = allocate(path, raster, raster_bytes(raster), error);
    return raster->samples ? PS_OK : PS_ERROR_MEMORY;
}

ps_result raster_rows_begin(const struct raster_source *source, struct raster *raster,
                            struct raster_rows *rows, struct error *error)
{
    const struct raster_lines *lines = source->lines;
    uint32_t texel_bytes = raster_texel_bytes(raster);
    *rows = (struct raster_rows){.raster = raster};
    ps_result result =
        raster_check_size(source->path, raster->width, raster->height, texel_bytes, error);
    if (result != PS_OK)
        return result;
    if (!lines || !lines->want(lines->user, raster))
        return raster_allocate(source->path, raster, error);
    rows->lines = lines;
    rows->line = allocate(source->path, raster, (size_t)raster->width * texel_bytes, error);
    return rows->line ? PS_OK : PS_ERROR_MEMORY;
}

void *raster_rows_next(const struct raster_rows *rows)
{
    return rows->lines ? rows->line : raster_row(rows->raster, rows->done);
}

ps_result raster_rows_add(struct raster_rows *rows, struct error *error)
{
    rows->done++;
    return rows->lines ? rows->lines->take(rows->lines->user, rows->line, error) : PS_OK;
}

void raster_rows_release(struct raster_rows *rows)
{
    free(rows->line);
    *rows = (struct raster_rows){0};
}

/* By the header's compression. */
static bool is_bmp_in_runs(const unsigned char *bytes, size_t size)
{
    return size >= BMP_COMPRESSION + 1 && memcmp(bytes, "BM", 2) == 0 &&
           (bytes[BMP_COMPRESSION] == 1 || bytes[BMP_COMPRESSION] == 2) && bytes[14] >= 40;
}

/* A TGA file starts with its header, of which only some bytes can be. */
static bool may_be_targa(const unsigned char *bytes, size_t size)
{
    if (size < TARGA_HEADER || bytes[1] > 1)
        return false;
    int kind = bytes[2] & ~8; /* 8: in runs */
    int depth = bytes[16];
    bool has_size = (bytes[12] || bytes[13]) && (bytes[14] || bytes[15]);
    return kind >= 1 && kind <= 3 && (kind == 1) == (bytes[1] == 1) && has_size &&
           (depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32);
}

static const struct format *find_format(const unsigned char *bytes, size_t size)
{
    if (is_bmp_in_runs(bytes, size))
        return &bmp_in_runs;
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        const struct format *format = &formats[i];
        if (size >= format->offset + format->length &&
            memcmp(bytes + format->offset, format->magic, format->length) == 0)
            return format;
    }
    return may_be_targa(bytes, size) ? &targa : NULL;
}

bool raster_is_known(const unsigned char *bytes, size_t size)
{
    const struct format *format = find_format(bytes, size);
    return format && format->read;
}

const char *raster_unread_kind(const unsigned char *bytes, size_t size)
{
    const struct format *format = find_format(bytes, size);
    return format && !format->read ? format->name : NULL;
}

static ps_result decode(const struct raster_source *source, struct raster *raster,
                        struct error *error)
{
    if (source->size == 0)
        return error_set(error, PS_ERROR_INVALID, "%s: it is empty", source->path);
    const struct format *format = find_format(source->bytes, source->size);
    if (format && format->read) {
        if (source->layer && format->read != raster_read_exr)
            return error_set(error, PS_ERROR_INVALID,
                             "%s: it is %s, which has no layers (OpenEXR has)", source->path,
                             format->name);
        return format->read(source, raster, error);
    }
    if (format)
        return error_set(error, PS_ERROR_INVALID, "%s: it is %s, which cannot be read (%s can)",
                         source->path, format->name, raster_kinds);
    return error_set(error, PS_ERROR_INVALID,
                     "%s: its content is none of a picture that can be read (%s)", source->path,
                     raster_kinds);
}

static ps_result fetch(const char *path, const struct input_file *file, unsigned char **bytes,
                       size_t *size, struct error *error)
{
    struct error reason;
    *size = (size_t)file->size;
    *bytes = malloc(*size + 1);
    if (!*bytes)
        return error_set(error, PS_ERROR_MEMORY, "%s: out of memory: wanted %zu bytes", path,
                         *size);
    ps_result result = input_file_read(file, *bytes, size, &reason);
    if (result == PS_OK && *size == file->size)
        return PS_OK;
    free(*bytes);
    if (result != PS_OK)
        return error_set(error, result, "%s: %.1000s", path, reason.text);
    return error_set(error, PS_ERROR_IO, "%s: it became shorter while it was read", path);
}

ps_result raster_fetch(const char *path, const char *folder, unsigned char **bytes, size_t *size,
                       struct error *error)
{
    struct input_file file;
    struct error reason;
    ps_result result = input_file_open(path, folder, &file, &reason);
    if (result != PS_OK)
        return error_set(error, result, "%s: %.1000s", path, reason.text);
    result = fetch(path, &file, bytes, size, error);
    close(file.descriptor);
    return result;
}

ps_result raster_decode(const char *path, const char *layer, const unsigned char *bytes,
                        size_t size, const struct raster_lines *lines, struct raster *raster,
                        struct error *error)
{
    struct raster_source source = {path, bytes, size, layer, lines};
    struct raster decoded = {.file_size = size};
    ps_result result = decode(&source, &decoded, error);
    if (result != PS_OK) {
        raster_release(&decoded);
        return result;
    }
    *raster = decoded;
    return PS_OK;
}
