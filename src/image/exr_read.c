/* exr_read.c: a flat OpenEXR file to a picture, through the library's C interface.
 *
 * The picture is the data window, wherever that lies; the image says where. Chunks (groups of
 * lines, or tiles) are decoded straight into the planes, which the library converts to float on the
 * way. It could also search a damaged file for chunks that its table does not list; that is
 * switched off, because half a picture that looks whole is worse than an error. The first of the
 * library's messages is the one shown: the later ones follow from it. Rasters are read from memory,
 * others from their file. Of tiles in several levels the largest is read. Where bands are wanted,
 * the planes have the lines of one.
 */
#include "image/exr_source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLE_SIZE ((int32_t)sizeof(float))

static void keep_first_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user_data = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user_data) != EXR_ERR_SUCCESS || !user_data)
        return;
    struct exr_source *source = user_data;
    if (source->message[0] == '\0')
        snprintf(source->message, sizeof source->message, "%s", message);
}

static exr_result_t provide_spare(struct exr_source *source, const exr_chunk_info_t *chunk)
{
    size_t count = (size_t)chunk->width * (size_t)chunk->height;
    if (!source->memory || count <= source->spare_count)
        return EXR_ERR_SUCCESS;
    free(source->spare);
    source->spare = malloc(count * sizeof *source->spare);
    source->spare_count = source->spare ? count : 0;
    return source->spare ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}

/* Tells the decoder where the channels of a chunk go whose upper left pixel in the planes is
 * (column, line). Decoder and picture have them in the order of the file. */
static void direct_channels(struct exr_source *source, const exr_chunk_info_t *chunk, size_t column,
                            size_t line)
{
    const struct image *image = &source->image;
    size_t taken = 0;
    for (int i = 0; i < source->decoder.channel_count; i++) {
        exr_coding_channel_info_t *channel = &source->decoder.channels[i];
        bool wanted = taken < image->channel_count &&
                      strcmp(image->channels[taken].name, channel->channel_name) == 0;
        float *samples = source->spare;
        size_t width = (size_t)chunk->width;
        if (wanted) {
            width = image->width;
            samples = image->channels[taken++].samples + line * width + column;
        }
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = (int16_t)SAMPLE_SIZE;
        channel->user_pixel_stride = SAMPLE_SIZE;
        channel->user_line_stride = (int32_t)width * SAMPLE_SIZE;
        channel->decode_to_ptr = (uint8_t *)samples;
    }
}

/* The library's own buffers. It takes a chunk of runs that ends too early for a whole one, with
 * what its buffer held before: no other picture's bytes. */
static void *allocate_zeros(exr_transcoding_pipeline_buffer_id_t id, size_t size)
{
    (void)id;
    return calloc(1, size);
}

static void release_zeros(exr_transcoding_pipeline_buffer_id_t id, void *buffer)
{
    (void)id;
    free(buffer);
}

/* Decodes the chunk whose upper left pixel in the picture is (column, line). */
static exr_result_t decode_chunk(struct exr_source *source, const exr_chunk_info_t *chunk,
                                 size_t column, size_t line)
{
    const struct image *image = &source->image;
    exr_decode_pipeline_t *decoder = &source->decoder;
    if (chunk->width <= 0 || chunk->height <= 0 || (size_t)chunk->width > image->width - column ||
        (size_t)chunk->height > source->height - line || (size_t)chunk->height > image->height)
        return EXR_ERR_CORRUPT_CHUNK;
    bool first = !source->decoding;
    exr_result_t code = first
                            ? exr_decoding_initialize(source->context, source->part, chunk, decoder)
                            : exr_decoding_update(source->context, source->part, chunk, decoder);
    if (code == EXR_ERR_SUCCESS) {
        source->decoding = true;
        decoder->alloc_fn = allocate_zeros;
        decoder->free_fn = release_zeros;
        code = provide_spare(source, chunk);
    }
    if (code != EXR_ERR_SUCCESS)
        return code;
    direct_channels(source, chunk, column, source->bands ? 0 : line);
    if (first)
        code = exr_decoding_choose_default_routines(source->context, source->part, decoder);
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(source->context, source->part, decoder)
                                   : code;
}

/* The chunks of a row of tiles, or a group of lines. */
static ps_result read_band(struct exr_source *source, size_t line)
{
    exr_chunk_info_t chunk;
    exr_result_t code = EXR_ERR_SUCCESS;
    size_t width = source->tile_width;
    if (width == 0) {
        int row = (int)(source->window.min.y + (int64_t)line);
        code = exr_read_scanline_chunk_info(source->context, source->part, row, &chunk);
        return exr_source_explain(
            source, code == EXR_ERR_SUCCESS ? decode_chunk(source, &chunk, 0, line) : code);
    }
    for (size_t column = 0; column < source->image.width && code == EXR_ERR_SUCCESS;
         column += width) {
        code = exr_read_tile_chunk_info(source->context, source->part, (int)(column / width),
                                        (int)(line / source->band_lines), 0, 0, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = decode_chunk(source, &chunk, column, line);
    }
    return exr_source_explain(source, code);
}

static ps_result read_chunks(struct exr_source *source)
{
    const struct exr_bands *bands = source->bands;
    ps_result result = PS_OK;
    for (size_t line = 0; line < source->height && result == PS_OK; line += source->band_lines) {
        size_t left = source->height - line;
        result = read_band(source, line);
        if (result == PS_OK && bands)
            result =
                bands->take(bands->user, &source->image, &source->facts,
                            left < source->band_lines ? left : source->band_lines, source->error);
    }
    return result;
}

static ps_result read_picture(struct exr_source *source)
{
    ps_result result = exr_header_read(source);
    if (result != PS_OK || source->image.channel_count == 0)
        return result;
    result = read_chunks(source);
    if (source->decoding)
        exr_decoding_destroy(source->context, &source->decoder);
    free(source->spare);
    return result;
}

static int64_t memory_size(exr_const_context_t context, void *user_data)
{
    const struct exr_source *source = user_data;
    (void)context;
    return (int64_t)source->memory->size;
}

/* Past the end it gives what there is, as read(2) does. */
static int64_t memory_read(exr_const_context_t context, void *user_data, void *buffer,
                           uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t report)
{
    const struct raster_source *memory = ((const struct exr_source *)user_data)->memory;
    (void)context;
    (void)report;
    if (offset >= memory->size)
        return 0;
    uint64_t left = memory->size - offset;
    memcpy(buffer, memory->bytes + offset, size < left ? size : left);
    return (int64_t)(size < left ? size : left);
}

static ps_result read_source(struct exr_source *source, struct image *image)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = keep_first_message;
    setup.user_data = source;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    if (source->memory) {
        setup.size_fn = memory_size;
        setup.read_fn = memory_read;
    }
    ps_result result =
        exr_source_explain(source, exr_start_read(&source->context, source->path, &setup));
    if (result != PS_OK)
        return result;
    result = read_picture(source);
    exr_finish(&source->context);
    if (result != PS_OK) {
        image_release(&source->image);
        return result;
    }
    *image = source->image;
    return PS_OK;
}

ps_result image_read_exr(const char *path, struct image *image, struct error *error)
{
    struct exr_source source = {.path = path, .error = error};
    return read_source(&source, image);
}

ps_result exr_read_layer(const struct raster_source *memory, const struct exr_bands *bands,
                         struct image *image, struct exr_facts *facts, struct error *error)
{
    struct exr_source source = {
        .path = memory->path, .memory = memory, .error = error, .bands = bands};
    ps_result result = read_source(&source, image);
    *facts = source.facts;
    return result;
}
