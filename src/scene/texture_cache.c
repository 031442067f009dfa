#include "scene/texture_cache.h"

#include "base/output_file.h"
#include "base/version.h"
#include "scene/mip_map.h"
#include "scene/mip_map_stream.h"
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

/* --- names
 * ----------------------------------------------------------------------------------------- */

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

/* --- tiles
 * ----------------------------------------------------------------------------------------- */

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

/* --- storing
 * --------------------------------------------------------------------------------------- */

/* The row of tiles that fills with lines, and where it goes in the file. */
struct tile_row {
    unsigned char *tiles; /* owned */
    uint64_t at;
};

struct texture_entry {
    struct output_file file;
    struct texture texture; /* what is known of it; owns nothing */
    struct mip_map_stream *stream;
    XXH3_state_t *digest;
    struct tile_row levels[TEXTURE_LEVELS];
};

/* In pieces: Linux maps at once as much of a file as was written at once, which would be more than
 * a block. */
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

/* Each tile of the row has the samples of a line where its own line begins. */
static void spread_line(const struct texels *level, size_t texel_bytes, uint32_t line,
                        const unsigned char *samples, unsigned char *tiles)
{
    uint32_t side = 1u << TILE_SHIFT;
    for (uint32_t left = 0; left < level->width; left += side) {
        uint32_t count = level->width - left < side ? level->width - left : side;
        size_t at = (left >> TILE_SHIFT) * TILE_TEXELS + ((size_t)(line % side) << TILE_SHIFT);
        memcpy(tiles + at * texel_bytes, samples + left * texel_bytes, count * texel_bytes);
    }
}

/* A mip_map_take. */
static ps_result take_line(void *user, uint32_t number, uint32_t line, const void *samples,
                           struct error *error)
{
    struct texture_entry *entry = user;
    const struct texels *level = &entry->texture.levels[number];
    struct tile_row *row = &entry->levels[number];
    size_t texel_bytes = entry->texture.texel_bytes;
    size_t bytes = row_bytes(level->width, entry->texture.texel_bytes);
    if (line % (1u << TILE_SHIFT) == 0)
        memset(row->tiles, 0, bytes);
    spread_line(level, texel_bytes, line, samples, row->tiles);
    if ((line + 1) % (1u << TILE_SHIFT) > 0 && line + 1 < level->height)
        return PS_OK;
    uint64_t at = row->at;
    row->at += bytes;
    return write_pieces(&entry->file, at, row->tiles, bytes, error);
}

/* Where the levels go, and room for a row of tiles of each. */
static bool place_rows(struct texture_entry *entry)
{
    const struct texture *texture = &entry->texture;
    uint64_t at = START;
    bool good = true;
    for (uint32_t i = 0; i < texture->level_count && good; i++) {
        const struct texels *level = &texture->levels[i];
        entry->levels[i] =
            (struct tile_row){malloc(row_bytes(level->width, texture->texel_bytes)), at};
        at += mip_map_level_bytes(level, TILE_SHIFT, texture->texel_bytes);
        good = entry->levels[i].tiles != NULL;
    }
    return good;
}

static void release_entry(struct texture_entry *entry)
{
    for (int i = 0; i < TEXTURE_LEVELS; i++)
        free(entry->levels[i].tiles);
    if (entry->digest)
        XXH3_freeState(entry->digest);
    mip_map_close(entry->stream);
    free(entry);
}

/* All but the file; NULL with a message. */
static struct texture_entry *create_entry(const struct texture *texture, struct error *error)
{
    struct texture_entry *entry = calloc(1, sizeof *entry);
    size_t wanted = 2 * row_bytes(texture->raster.width, texture->texel_bytes);
    bool good = entry != NULL;
    if (good) {
        struct texture *own = &entry->texture;
        *own = *texture;
        own->has_extremes = false;
        own->levels[0] =
            (struct texels){.width = texture->raster.width, .height = texture->raster.height};
        own->level_count =
            mip_map_has_more(own) ? mip_map_level_count(own->raster.width, own->raster.height) : 1;
        mip_map_place(own, 1, NULL);
        entry->digest = XXH3_createState();
        good = place_rows(entry) && entry->digest && XXH3_64bits_reset(entry->digest) == XXH_OK;
    }
    if (good) {
        entry->stream = mip_map_open(&entry->texture, take_line, entry, error);
    } else {
        error_memory(error, wanted, "a texture's entry in the cache");
    }
    if (!entry || entry->stream)
        return entry;
    release_entry(entry);
    return NULL;
}

struct texture_entry *texture_entry_begin(const char *path, const struct texture *texture,
                                          struct error *error)
{
    struct texture_entry *entry = create_entry(texture, error);
    if (!entry || output_file_open(&entry->file, path, error) == PS_OK)
        return entry;
    release_entry(entry);
    return NULL;
}

ps_result texture_entry_add(struct texture_entry *entry, const void *samples, struct error *error)
{
    size_t bytes = (size_t)entry->texture.raster.width * entry->texture.texel_bytes;
    XXH3_64bits_update(entry->digest, samples, bytes);
    texture_widen_extremes(&entry->texture, samples, entry->texture.raster.width);
    return mip_map_add_line(entry->stream, samples, error);
}

static struct header header_of(const struct texture_entry *entry)
{
    const struct texture *texture = &entry->texture;
    const struct raster *raster = &texture->raster;
    struct header header = {
        .size = file_bytes(texture),
        .digest = XXH3_64bits_digest(entry->digest),
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

ps_result texture_entry_end(struct texture_entry *entry, size_t mended, struct error *error)
{
    entry->texture.raster.mended = mended;
    struct header header = header_of(entry);
    ps_result result = output_file_write(&entry->file, 0, &header, sizeof header, error);
    if (result == PS_OK)
        result = output_file_commit(&entry->file, error);
    else
        output_file_discard(&entry->file);
    release_entry(entry);
    return result;
}

void texture_entry_discard(struct texture_entry *entry)
{
    if (!entry)
        return;
    output_file_discard(&entry->file);
    release_entry(entry);
}

/* --- loading
 * --------------------------------------------------------------------------------------- */

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
