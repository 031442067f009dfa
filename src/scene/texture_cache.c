#include "scene/texture_cache.h"

#include "base/output_file.h"
#include "base/version.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#define TILE_SHIFT 6 /* tiles of 64 x 64 texels take one page of memory for each byte of a texel */
#define TILE_TEXELS ((size_t)1 << 2 * TILE_SHIFT)
#define START 4096 /* of the texels */

/* Before the texels. */
struct header {
    char magic[8];
    uint64_t size; /* of the file */
    uint64_t digest;
    uint64_t mended, file_size; /* as raster.h has them */
    uint32_t width, height, channels, sample, srgb, has_extremes;
    float lowest, highest;
};

static const char magic[8] = "psplatT";

/* --- names ----------------------------------------------------------------------------------------- */

/* PSPLAT_DECODER is a digest of the sources that decode pictures, and of these. */
char *texture_cache_path(const char *folder, const unsigned char *bytes, size_t size,
                         const char *layer)
{
    static const char program[] = PSPLAT_VERSION " " PSPLAT_DECODER;
    uint64_t key = XXH3_64bits(program, sizeof program);
    key = XXH3_64bits_withSeed(bytes, size, key);
    if (layer)
        key = XXH3_64bits_withSeed(layer, strlen(layer), key);
    size_t length = strlen(folder) + sizeof "/0123456789abcdef.texture";
    char *path = malloc(length);
    if (path)
        snprintf(path, length, "%s/%016" PRIx64 ".texture", folder, key);
    return path;
}

/* --- tiles ----------------------------------------------------------------------------------------- */

static uint32_t tiles_along(uint32_t texels)
{
    return (texels + (1u << TILE_SHIFT) - 1) >> TILE_SHIFT;
}

/* Of a row of tiles. */
static size_t row_bytes(uint32_t width, uint32_t texel_bytes)
{
    return tiles_along(width) * TILE_TEXELS * texel_bytes;
}

static uint64_t file_bytes(const struct texture *texture, uint32_t width, uint32_t height)
{
    return START + (uint64_t)tiles_along(height) * row_bytes(width, texture->texel_bytes);
}

/* The texels of a row of tiles, each of which has its own row by row. */
static void fill_row(const struct texture *texture, uint32_t row, unsigned char *tiles)
{
    const struct texels *texels = &texture->texels;
    uint32_t side = 1u << TILE_SHIFT, top = row << TILE_SHIFT;
    size_t texel = texture->texel_bytes;
    uint32_t lines = texels->height - top < side ? texels->height - top : side;
    for (uint32_t line = 0; line < lines; line++) {
        const unsigned char *from = texels->bytes + (size_t)(top + line) * texels->width * texel;
        for (uint32_t left = 0; left < texels->width; left += side) {
            uint32_t count = texels->width - left < side ? texels->width - left : side;
            size_t at = (left >> TILE_SHIFT) * TILE_TEXELS + ((size_t)line << TILE_SHIFT);
            memcpy(tiles + at * texel, from + left * texel, count * texel);
        }
    }
}

/* --- storing --------------------------------------------------------------------------------------- */

/* In pieces: Linux maps at once as much of a file as was written at once, which would be more than a block. */
static ps_result write_pieces(const struct output_file *file, uint64_t at,
                              const unsigned char *bytes, size_t size, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t done = 0; done < size && result == PS_OK; done += MAPPED_BLOCK) {
        size_t piece = size - done < MAPPED_BLOCK ? size - done : MAPPED_BLOCK;
        result = output_file_write(file, at + done, bytes + done, piece, error);
    }
    return result;
}

static ps_result write_texels(const struct texture *texture, const struct output_file *file,
                              struct error *error)
{
    size_t bytes = row_bytes(texture->texels.width, texture->texel_bytes);
    unsigned char *tiles = calloc(1, bytes);
    if (!tiles)
        return error_memory(error, bytes, "a texture's entry in the cache");
    ps_result result = PS_OK;
    uint32_t rows = tiles_along(texture->texels.height);
    for (uint32_t row = 0; row < rows && result == PS_OK; row++) {
        fill_row(texture, row, tiles);
        result = write_pieces(file, START + row * bytes, tiles, bytes, error);
    }
    free(tiles);
    return result;
}

static struct header header_of(struct texture *texture)
{
    const struct raster *raster = &texture->raster;
    texture_find_extremes(texture);
    struct header header = {
        .size = file_bytes(texture, raster->width, raster->height),
        .digest = texture_digest(texture),
        .mended = raster->mended,
        .file_size = raster->file_size,
        .width = raster->width,
        .height = raster->height,
        .channels = raster->channels,
        .sample = raster->sample,
        .srgb = raster->srgb,
        .has_extremes = texture->has_extremes,
        .lowest = texture->lowest,
        .highest = texture->highest,
    };
    memcpy(header.magic, magic, sizeof magic);
    return header;
}

ps_result texture_cache_store(const char *path, struct texture *texture, struct error *error)
{
    struct output_file file;
    struct header header = header_of(texture);
    ps_result result = output_file_open(&file, path, error);
    if (result != PS_OK)
        return result;
    result = output_file_write(&file, 0, &header, sizeof header, error);
    if (result == PS_OK)
        result = write_texels(texture, &file, error);
    if (result == PS_OK)
        return output_file_commit(&file, error);
    output_file_discard(&file);
    return result;
}

/* --- loading --------------------------------------------------------------------------------------- */

static bool is_whole(const struct texture *texture, const struct header *header, size_t size)
{
    return memcmp(header->magic, magic, sizeof magic) == 0 && header->size == size &&
           header->width > 0 && header->height > 0 &&
           size == file_bytes(texture, header->width, header->height);
}

/* All but what file, texels and the rest of the description tell. */
static void take_header(const struct header *header, struct texture *texture)
{
    texture->raster = (struct raster){
        .width = header->width,
        .height = header->height,
        .channels = header->channels,
        .sample = (enum raster_sample)header->sample,
        .srgb = header->srgb != 0,
        .mended = header->mended,
        .file_size = header->file_size,
    };
    texture->texel_bytes = raster_texel_bytes(&texture->raster);
    texture->tile_shift = TILE_SHIFT;
    texture->has_extremes = header->has_extremes != 0;
    texture->lowest = header->lowest;
    texture->highest = header->highest;
    texture->digest = header->digest;
}

ps_result texture_cache_load(const char *path, struct mapped_budget *budget,
                             struct texture *texture, struct error *error)
{
    struct header header;
    struct texture loaded = {0};
    struct mapped_file *file = mapped_file_open(path, budget, error);
    if (!file)
        return PS_ERROR_IO;
    if (file->size >= START) {
        memcpy(&header, file->bytes, sizeof header);
        if (header.channels <= 4 && header.sample <= RASTER_FLOAT)
            take_header(&header, &loaded);
    }
    if (file->size < START || !is_whole(&loaded, &header, file->size)) {
        mapped_file_close(file);
        return error_set(error, PS_ERROR_IO, "%s: it is no whole entry", path);
    }
    loaded.file = file;
    loaded.texels = (struct texels){header.width, header.height, tiles_along(header.width),
                                    file->bytes + START};
    *texture = loaded;
    return PS_OK;
}
