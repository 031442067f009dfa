#include "scene/texture_cache.h"

#include "base/output_file.h"
#include "base/version.h"
#include "scene/mip_map.h"
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
    uint32_t width, height, levels, channels, sample, srgb, has_extremes;
    float lowest, highest;
};

static const char magic[8] = "psplatT";

/* --- names ----------------------------------------------------------------------------------------- */

/* PSPLAT_DECODER is a digest of the sources that decode pictures, and of these. */
char *texture_cache_path(const char *folder, const struct texture_description *description,
                         const unsigned char *bytes, size_t size)
{
    static const char program[] = PSPLAT_VERSION " " PSPLAT_DECODER;
    const char *layer = description->layer;
    uint64_t key = XXH3_64bits_withSeed(program, sizeof program, (uint64_t)description->encoding);
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

static uint64_t file_bytes(const struct texture *texture)
{
    uint64_t size = START;
    for (uint32_t i = 0; i < texture->level_count; i++)
        size += mip_map_level_bytes(&texture->levels[i], TILE_SHIFT, texture->texel_bytes);
    return size;
}

/* The texels of a row of tiles, each of which has its own row by row. */
static void fill_row(const struct texels *level, size_t texel_bytes, uint32_t row,
                     unsigned char *tiles)
{
    uint32_t side = 1u << TILE_SHIFT, top = row << TILE_SHIFT;
    uint32_t lines = level->height - top < side ? level->height - top : side;
    for (uint32_t line = 0; line < lines; line++) {
        const unsigned char *from =
            level->bytes + (size_t)(top + line) * level->width * texel_bytes;
        for (uint32_t left = 0; left < level->width; left += side) {
            uint32_t count = level->width - left < side ? level->width - left : side;
            size_t at = (left >> TILE_SHIFT) * TILE_TEXELS + ((size_t)line << TILE_SHIFT);
            memcpy(tiles + at * texel_bytes, from + left * texel_bytes, count * texel_bytes);
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

static ps_result write_level(const struct texels *level, uint32_t texel_bytes,
                             const struct output_file *file, uint64_t at, struct error *error)
{
    size_t bytes = row_bytes(level->width, texel_bytes);
    unsigned char *tiles = calloc(1, bytes);
    if (!tiles)
        return error_memory(error, bytes, "a texture's entry in the cache");
    ps_result result = PS_OK;
    uint32_t rows = tiles_along(level->height);
    for (uint32_t row = 0; row < rows && result == PS_OK; row++) {
        fill_row(level, texel_bytes, row, tiles);
        result = write_pieces(file, at + row * bytes, tiles, bytes, error);
    }
    free(tiles);
    return result;
}

static ps_result write_levels(const struct texture *texture, const struct output_file *file,
                              struct error *error)
{
    ps_result result = PS_OK;
    uint64_t at = START;
    for (uint32_t i = 0; i < texture->level_count && result == PS_OK; i++) {
        result = write_level(&texture->levels[i], texture->texel_bytes, file, at, error);
        at += mip_map_level_bytes(&texture->levels[i], TILE_SHIFT, texture->texel_bytes);
    }
    return result;
}

static struct header header_of(struct texture *texture)
{
    const struct raster *raster = &texture->raster;
    texture_find_extremes(texture);
    struct header header = {
        .size = file_bytes(texture),
        .digest = texture_digest(texture),
        .mended = raster->mended,
        .file_size = raster->file_size,
        .width = raster->width,
        .height = raster->height,
        .levels = texture->level_count,
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
        result = write_levels(texture, &file, error);
    if (result == PS_OK)
        return output_file_commit(&file, error);
    output_file_discard(&file);
    return result;
}

/* --- loading --------------------------------------------------------------------------------------- */

static bool is_possible(const struct header *header)
{
    return memcmp(header->magic, magic, sizeof magic) == 0 && header->width > 0 &&
           header->width <= RASTER_SIDE_LIMIT && header->height > 0 &&
           header->height <= RASTER_SIDE_LIMIT && header->levels > 0 &&
           header->levels <= mip_map_level_count(header->width, header->height) &&
           header->channels > 0 && header->channels <= 4 && header->sample <= RASTER_FLOAT;
}

/* All that the entry tells of the texture. */
static void refer_to_entry(struct texture *texture, const struct header *header,
                           struct mapped_file *file)
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
    texture->file = file;
    texture->halves = NULL;
    texture->level_count = header->levels;
    texture->levels[0] = (struct texels){.width = header->width, .height = header->height};
    mip_map_place(texture, 0, file->bytes + START);
}

ps_result texture_cache_load(const char *path, struct mapped_budget *budget,
                             struct texture *texture, struct error *error)
{
    struct header header;
    struct texture loaded = *texture;
    struct mapped_file *file = mapped_file_open(path, budget, error);
    if (!file)
        return PS_ERROR_IO;
    bool good = file->size >= START;
    if (good) {
        memcpy(&header, file->bytes, sizeof header);
        good = header.size == file->size && is_possible(&header);
    }
    if (good) {
        refer_to_entry(&loaded, &header, file);
        good = file_bytes(&loaded) == file->size;
    }
    if (!good) {
        mapped_file_close(file);
        return error_set(error, PS_ERROR_IO, "%s: it is no whole entry", path);
    }
    *texture = loaded;
    return PS_OK;
}
