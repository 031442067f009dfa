#include "image/exr_tiles.h"

#include "image/exr_output.h"
#include <assert.h>
#include <stdlib.h>

struct exr_tiles {
    struct exr_output output;
    size_t across, down;
    bool *written;      /* across * down */
    struct image black; /* a tile of zeros, with all channels */
};

/* Tiles side by side, and where their samples are. */
struct tile_run {
    size_t left, top, across; /* in tiles */
    size_t first;             /* pixel of the image where the first of them begins */
};

static size_t tile_x(const struct exr_chunks *chunks, size_t index)
{
    const struct tile_run *run = chunks->user;
    return run->left + index % run->across;
}

static size_t tile_y(const struct exr_chunks *chunks, size_t index)
{
    const struct tile_run *run = chunks->user;
    return run->top + index / run->across;
}

static exr_result_t describe(const struct exr_chunks *chunks, size_t index, exr_chunk_info_t *chunk)
{
    return exr_write_tile_chunk_info(chunks->output->context, EXR_OUTPUT_PART,
                                     (int)tile_x(chunks, index), (int)tile_y(chunks, index), 0, 0,
                                     chunk);
}

static size_t begins(const struct exr_chunks *chunks, size_t index)
{
    const struct tile_run *run = chunks->user;
    size_t x = index % run->across, y = index / run->across;
    return run->first + (y * chunks->image->width + x) * EXR_TILE_SIDE;
}

static exr_result_t store(const struct exr_chunks *chunks, size_t index, const void *bytes,
                          uint64_t size)
{
    return exr_write_tile_chunk(chunks->output->context, EXR_OUTPUT_PART,
                                (int)tile_x(chunks, index), (int)tile_y(chunks, index), 0, 0, bytes,
                                size);
}

static ps_result write_run(struct exr_tiles *tiles, const struct tile_run *run, size_t down,
                           const struct image *image, struct workers *workers, struct error *error)
{
    const struct exr_chunks chunks = {
        .output = &tiles->output,
        .image = image,
        .count = run->across * down,
        .describe = describe,
        .begins = begins,
        .store = store,
        .user = run,
    };
    for (size_t y = run->top; y < run->top + down; y++)
        for (size_t x = run->left; x < run->left + run->across; x++)
            tiles->written[y * tiles->across + x] = true;
    return exr_chunks_write(&chunks, workers, error);
}

static size_t in_tiles(size_t pixels)
{
    return (pixels + EXR_TILE_SIDE - 1) / EXR_TILE_SIDE;
}

/* The part with the channels of the file, in their order; `zeros`, which are allocated, where it
 * lacks one. Both are freed by the caller in any case. */
static ps_result complete(const struct exr_tiles *tiles, const struct image *part,
                          struct image_channel **channels, float **zeros, struct error *error)
{
    const struct image *all = &tiles->black;
    size_t count = all->channel_count, bytes = part->width * part->height * sizeof **zeros;
    *channels = malloc((count + 1) * sizeof **channels);
    *zeros = NULL;
    for (size_t i = 0; i < count && *channels; i++) {
        float *samples = (float *)image_channel(part, all->channels[i].name);
        if (!samples && !*zeros)
            *zeros = calloc(bytes + 1, 1);
        (*channels)[i] = (struct image_channel){all->channels[i].name, samples ? samples : *zeros};
        if (!samples && !*zeros)
            return error_memory(error, bytes, "a tile");
    }
    return *channels ? PS_OK : error_memory(error, count * sizeof **channels, "a tile");
}

ps_result exr_tiles_add(struct exr_tiles *tiles, const struct image *part, struct rectangle place,
                        struct workers *workers, struct error *error)
{
    size_t left = part->window.left, top = part->window.top;
    assert(place.x % EXR_TILE_SIDE == 0 && place.y % EXR_TILE_SIDE == 0);
    assert(place.x >= left && place.x + place.width <= left + part->width);
    assert(place.y >= top && place.y + place.height <= top + part->height);
    const struct tile_run run = {
        .left = place.x / EXR_TILE_SIDE,
        .top = place.y / EXR_TILE_SIDE,
        .across = in_tiles(place.width),
        .first = (place.y - top) * part->width + place.x - left,
    };
    struct image whole = *part;
    float *zeros;
    ps_result result = complete(tiles, part, &whole.channels, &zeros, error);
    whole.channel_count = tiles->black.channel_count;
    if (result == PS_OK)
        result = write_run(tiles, &run, in_tiles(place.height), &whole, workers, error);
    free(whole.channels);
    free(zeros);
    return result;
}

/* --- the file
 * ---------------------------------------------------------------------------------- */

static void destroy(struct exr_tiles *tiles)
{
    image_release(&tiles->black);
    free(tiles->written);
    free(tiles);
}

static ps_result make_black(struct exr_tiles *tiles, const struct image *like, struct error *error)
{
    tiles->black.width = tiles->black.height = EXR_TILE_SIDE;
    for (size_t i = 0; i < like->channel_count; i++)
        if (!image_add_channel(&tiles->black, like->channels[i].name))
            return error_memory(error, EXR_TILE_SIDE * EXR_TILE_SIDE * sizeof(float), "a tile");
    return PS_OK;
}

static ps_result open_file(struct exr_tiles *tiles, const char *path, const struct image *like,
                           size_t width, size_t height, enum image_compression compression,
                           struct error *error)
{
    struct image whole = *like;
    whole.width = width;
    whole.height = height;
    whole.window = (struct picture_window){0};
    return exr_output_open(&tiles->output, path, &whole, EXR_TILE_SIDE, compression, error);
}

ps_result exr_tiles_create(const char *path, const struct image *like, size_t width, size_t height,
                           enum image_compression compression, struct exr_tiles **created,
                           struct error *error)
{
    size_t across = in_tiles(width), down = in_tiles(height);
    struct exr_tiles *tiles = calloc(1, sizeof *tiles);
    *created = NULL;
    if (!tiles)
        return error_memory(error, sizeof *tiles, "a file of tiles");
    *tiles = (struct exr_tiles){.across = across, .down = down};
    tiles->written = calloc(across * down, sizeof *tiles->written);
    ps_result result = tiles->written ? make_black(tiles, like, error)
                                      : error_memory(error, across * down, "a file of tiles");
    if (result == PS_OK)
        result = open_file(tiles, path, like, width, height, compression, error);
    if (result == PS_OK)
        *created = tiles;
    else
        destroy(tiles);
    return result;
}

ps_result exr_tiles_finish(struct exr_tiles *tiles, struct workers *workers, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < tiles->across * tiles->down && result == PS_OK; i++) {
        const struct tile_run run = {
            .left = i % tiles->across, .top = i / tiles->across, .across = 1};
        if (!tiles->written[i])
            result = write_run(tiles, &run, 1, &tiles->black, workers, error);
    }
    result = exr_output_close(&tiles->output, result, error);
    destroy(tiles);
    return result;
}

void exr_tiles_discard(struct exr_tiles *tiles)
{
    struct error ignored;
    if (!tiles)
        return;
    exr_output_close(&tiles->output, PS_CANCELLED, &ignored);
    destroy(tiles);
}
