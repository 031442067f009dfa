#include "session/tiled_output.h"

#include "image/exr_tiles.h"
#include "image/png_rows.h"
#include <stdlib.h>
#include <string.h>

/* One of the two is there. */
struct tiled_file {
    struct exr_tiles *exr;
    struct png_rows *png;
};

struct tiled_output {
    struct tiled_file *files;
    size_t count;
    const struct output_options *options;
    struct workers *workers;
    size_t width, height;
    uint8_t *row; /* of tiles, for PNG files; NULL: there are none */
    size_t top, row_height;
};

/* --- rows of tiles for PNG files
 * ---------------------------------------------------------------- */

/* Writes the row of tiles, and begins the next one. */
static ps_result end_row(struct tiled_output *output, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < output->count && result == PS_OK; i++)
        if (output->files[i].png)
            result = png_rows_add(output->files[i].png, output->row, output->row_height, error);
    output->top += output->row_height;
    if (output->row_height > output->height - output->top)
        output->row_height = output->height - output->top;
    memset(output->row, 0, 3 * output->width * output->row_height);
    return result;
}

static ps_result add_to_row(struct tiled_output *output, const struct image *part,
                            struct rectangle tile, struct error *error)
{
    output_encode(part, tile, output->row + 3 * tile.x, 3 * output->width, output->workers);
    return tile.x + tile.width == output->width ? end_row(output, error) : PS_OK;
}

/* --- files
 * ----------------------------------------------------------------------------------------- */

static ps_result add_to_exr(const struct tiled_output *output, const struct image *part,
                            struct rectangle tile, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < output->count && result == PS_OK; i++)
        if (output->files[i].exr)
            result = exr_tiles_add(output->files[i].exr, part, tile, output->workers, error);
    return result;
}

ps_result tiled_output_add(struct tiled_output *output, const struct image *part,
                           struct rectangle tile, struct error *error)
{
    ps_result result = add_to_exr(output, part, tile, error);
    return result == PS_OK && output->row ? add_to_row(output, part, tile, error) : result;
}

static ps_result open_files(struct tiled_output *output, const char *const paths[],
                            const struct image *first, struct error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < output->count && result == PS_OK; i++) {
        struct image kept;
        if (!output_holds_layers(paths[i])) {
            result = png_rows_create(paths[i], output->width, output->height, first->attributes,
                                     first->attribute_count, &output->files[i].png, error);
            continue;
        }
        result = output_kept_layers(first, output->options, &kept, error);
        if (result == PS_OK)
            result = exr_tiles_create(paths[i], &kept, output->width, output->height,
                                      output->options->compression, &output->files[i].exr, error);
        free(kept.channels);
    }
    return result;
}

static ps_result create_row(struct tiled_output *output, size_t tile_height, struct error *error)
{
    bool wanted = false;
    for (size_t i = 0; i < output->count; i++)
        wanted |= output->files[i].png != NULL;
    output->row_height = tile_height < output->height ? tile_height : output->height;
    size_t bytes = 3 * output->width * output->row_height;
    if (!wanted)
        return PS_OK;
    output->row = calloc(bytes, 1);
    return output->row ? PS_OK : error_memory(error, bytes, "a row of tiles");
}

ps_result tiled_output_create(const char *const paths[], size_t count,
                              const struct output_options *options, const struct image *first,
                              size_t width, size_t height, size_t tile, struct workers *workers,
                              struct tiled_output **created, struct error *error)
{
    struct tiled_output *output = calloc(1, sizeof *output);
    *created = output;
    if (!output)
        return error_memory(error, sizeof *output, "files of tiles");
    *output = (struct tiled_output){.files = calloc(count + 1, sizeof *output->files),
                                    .count = count,
                                    .options = options,
                                    .workers = workers,
                                    .width = width,
                                    .height = height};
    ps_result result = PS_ERROR_MEMORY;
    if (output->files)
        result = open_files(output, paths, first, error);
    else
        error_memory(error, count * sizeof *output->files, "files of tiles");
    if (result == PS_OK)
        result = create_row(output, tile, error);
    if (result == PS_OK)
        return PS_OK;
    tiled_output_discard(output);
    *created = NULL;
    return result;
}

static void destroy(struct tiled_output *output)
{
    free(output->files);
    free(output->row);
    free(output);
}

ps_result tiled_output_finish(struct tiled_output *output, struct error *error)
{
    ps_result first = PS_OK;
    while (output->row && output->top < output->height && first == PS_OK)
        first = end_row(output, error);
    for (size_t i = 0; i < output->count; i++) {
        struct error reason;
        struct tiled_file *file = &output->files[i];
        ps_result result = PS_OK;
        if (file->exr) {
            result = exr_tiles_finish(file->exr, output->workers, &reason);
        } else if (first == PS_OK) {
            result = png_rows_finish(file->png, &reason);
        } else {
            png_rows_discard(file->png);
        }
        if (result != PS_OK && first == PS_OK) {
            first = result;
            *error = reason;
        }
    }
    destroy(output);
    return first;
}

void tiled_output_discard(struct tiled_output *output)
{
    if (!output)
        return;
    for (size_t i = 0; output->files && i < output->count; i++) {
        exr_tiles_discard(output->files[i].exr);
        png_rows_discard(output->files[i].png);
    }
    destroy(output);
}
