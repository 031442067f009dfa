/* exr_write.c: a picture to a scan-line OpenEXR file, through the library's C interface.
 *
 * The order of calls matters and is written down nowhere: start, add the part, required attributes,
 * channels, other attributes, header; then for each chunk its information, the encoder (initialised
 * with a thread's first chunk, updated with the others), the planes' pointers *moved to that chunk's
 * first line*, and the run; then finish. Bytes go through output_file rather than the library's own
 * file handling, so that the file appears whole and a failed write says why.
 *
 * Compression takes nearly all of the time, so chunks are shared out among threads, each with an
 * encoder of its own on the one context, as the library has it. A thread that is done with a chunk
 * waits for its turn before writing it: the file has its chunks in order, is the same for any number
 * of threads, and no more than one chunk a thread is in memory. Chunks are handed out in order, so
 * whoever holds the first that is missing never waits.
 *
 * The library's messages are dropped: its handler runs with the context locked while writing, so it
 * cannot ask for our data; result codes with what was being written tell as much. No capDate: the
 * same picture gives the same bytes.
 */
#include "base/output_file.h"
#include "base/parallel.h"
#include "image/image.h"

#include <OpenEXR/openexr.h>
#include <pthread.h>
#include <stdbool.h>
#include <string.h>

#define MOST_LINES 16        /* of a chunk */
#define SHORT_NAME_LENGTH 31 /* longer names need a flag that readers before 2012 lack */
#define PART 0               /* the file's only part */
#define SAMPLE_SIZE ((int32_t)sizeof(float))

/* Of zlib, whose own is 6: a fifth to a quarter of the time less for files 1 to 2 per cent longer.
 * Levels below save no more: what radiance costs is its noise. */
#define ZIP_LEVEL 3

/* ITU-R BT.709-6: x and y of red, green, blue, and of white (D65). */
static const exr_attr_chromaticities_t rec709 = {0.64f, 0.33f, 0.30f,   0.60f,
                                                 0.15f, 0.06f, 0.3127f, 0.3290f};

/* By enum image_compression: how the library calls it, and how many lines make a chunk. */
static const struct {
    const char *name;
    exr_compression_t code;
    size_t lines;
} compressions[] = {
    [IMAGE_ZIP] = {"zip", EXR_COMPRESSION_ZIP, MOST_LINES},
    [IMAGE_ZIPS] = {"zips", EXR_COMPRESSION_ZIPS, 1},
    [IMAGE_RLE] = {"rle", EXR_COMPRESSION_RLE, 1},
    [IMAGE_UNCOMPRESSED] = {"none", EXR_COMPRESSION_NONE, 1},
};

struct exr_sink {
    struct output_file file;
    struct error *error;
    bool failed; /* a write failed, and `error` already says why */
};

static void drop_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static int64_t write_bytes(exr_const_context_t context, void *user_data, const void *bytes,
                           uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t report)
{
    struct exr_sink *sink = user_data;
    (void)context;
    (void)report;
    if (output_file_write(&sink->file, offset, bytes, (size_t)size, sink->error) != PS_OK) {
        sink->failed = true;
        return -1;
    }
    return (int64_t)size;
}

static ps_result explain(const struct exr_sink *sink, exr_result_t code, const char *kind,
                         const char *name)
{
    if (code == EXR_ERR_SUCCESS)
        return PS_OK;
    if (sink->failed)
        return PS_ERROR_IO;
    return error_set(sink->error,
                     code == EXR_ERR_OUT_OF_MEMORY ? PS_ERROR_MEMORY : PS_ERROR_INVALID,
                     "cannot write '%s' (%s %s): %s", sink->file.path, kind, name,
                     exr_get_default_error_message(code));
}

/* What the format, or the library's 32-bit sizes, cannot hold. */
static ps_result check_picture(const struct image *image, const char *path, struct error *error)
{
    if (image->width == 0 || image->height == 0 || image->channel_count == 0)
        return error_set(error, PS_ERROR_INVALID, "cannot write '%s': the picture is empty", path);
    size_t bytes_per_column = image->channel_count * MOST_LINES * sizeof(float);
    if (image->height > INT32_MAX || image->channel_count > INT16_MAX ||
        image->width > INT32_MAX / bytes_per_column) {
        return error_set(error, PS_ERROR_INVALID,
                         "cannot write '%s': %zu x %zu pixels of %zu channels are too many for "
                         "OpenEXR",
                         path, image->width, image->height, image->channel_count);
    }
    for (size_t i = 0; i < image->channel_count; i++) {
        const char *name = image->channels[i].name;
        if (image_channel(image, name) != image->channels[i].samples) {
            return error_set(error, PS_ERROR_INVALID, "cannot write '%s': two channels named '%s'",
                             path, name);
        }
    }
    return PS_OK;
}

static bool needs_long_names(const struct image *image)
{
    bool needed = false;
    for (size_t i = 0; i < image->channel_count; i++)
        needed = needed || strlen(image->channels[i].name) > SHORT_NAME_LENGTH;
    for (size_t i = 0; i < image->attribute_count; i++)
        needed = needed || strlen(image->attributes[i].name) > SHORT_NAME_LENGTH;
    return needed;
}

static exr_attr_box2i_t box(size_t left, size_t top, size_t width, size_t height)
{
    exr_attr_box2i_t box;
    box.min.x = (int32_t)left;
    box.min.y = (int32_t)top;
    box.max.x = (int32_t)(left + width - 1);
    box.max.y = (int32_t)(top + height - 1);
    return box;
}

static exr_result_t set_windows(exr_context_t context, const struct image *image,
                                exr_compression_t compression)
{
    const struct picture_window *window = &image->window;
    exr_attr_box2i_t data = box(window->left, window->top, image->width, image->height);
    exr_attr_box2i_t display =
        window->picture_width > 0 ? box(0, 0, window->picture_width, window->picture_height) : data;
    exr_attr_v2f_t center;
    center.x = center.y = 0.0f;
    return exr_initialize_required_attr(context, PART, &display, &data, 1.0f, &center, 1.0f,
                                        EXR_LINEORDER_INCREASING_Y, compression);
}

static ps_result write_header(exr_context_t context, const struct image *image,
                              enum image_compression compression, const struct exr_sink *sink)
{
    exr_result_t code = exr_set_longname_support(context, needs_long_names(image));
    if (code == EXR_ERR_SUCCESS)
        code = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, NULL);
    if (code == EXR_ERR_SUCCESS) {
        code = set_windows(context, image, compressions[compression].code);
    }
    if (code == EXR_ERR_SUCCESS)
        code = exr_set_zip_compression_level(context, PART, ZIP_LEVEL);
    if (code == EXR_ERR_SUCCESS)
        code = exr_attr_set_chromaticities(context, PART, "chromaticities", &rec709);
    ps_result result = explain(sink, code, "the", "header");
    for (size_t i = 0; i < image->channel_count && result == PS_OK; i++) {
        const char *name = image->channels[i].name;
        code = exr_add_channel(context, PART, name, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC,
                               1, 1);
        result = explain(sink, code, "channel", name);
    }
    for (size_t i = 0; i < image->attribute_count && result == PS_OK; i++) {
        const struct image_attribute *attribute = &image->attributes[i];
        code = exr_attr_set_string(context, PART, attribute->name, attribute->value);
        result = explain(sink, code, "attribute", attribute->name);
    }
    if (result != PS_OK)
        return result;
    return explain(sink, exr_write_header(context), "the", "header");
}

/* The library holds the channels sorted, so each is looked up by its name. */
static void point_at_line(exr_encode_pipeline_t *encoder, const struct image *image, size_t line)
{
    for (int i = 0; i < encoder->channel_count; i++) {
        exr_coding_channel_info_t *channel = &encoder->channels[i];
        const float *samples = image_channel(image, channel->channel_name);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = (int16_t)SAMPLE_SIZE;
        channel->user_pixel_stride = SAMPLE_SIZE;
        channel->user_line_stride = (int32_t)image->width * SAMPLE_SIZE;
        channel->encode_from_ptr = (const uint8_t *)(samples + line * image->width);
    }
}

/* The chunks of a picture on their way to the file. Lines stand for the chunks they begin. */
struct chunk_queue {
    exr_context_t context;
    const struct image *image;
    size_t lines;         /* of each */
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t moved; /* `written` or `code` has changed */
    size_t handed_out;    /* lines that were given to threads */
    size_t written;       /* lines that are in the file */
    exr_result_t code;    /* of the first failure; ends the work */
};

static bool take_chunk(struct chunk_queue *queue, size_t *line)
{
    pthread_mutex_lock(&queue->lock);
    bool left = queue->code == EXR_ERR_SUCCESS && queue->handed_out < queue->image->height;
    *line = queue->handed_out;
    queue->handed_out += left ? queue->lines : 0;
    pthread_mutex_unlock(&queue->lock);
    return left;
}

static void give_up(struct chunk_queue *queue, exr_result_t code)
{
    pthread_mutex_lock(&queue->lock);
    if (queue->code == EXR_ERR_SUCCESS)
        queue->code = code;
    pthread_cond_broadcast(&queue->moved);
    pthread_mutex_unlock(&queue->lock);
}

/* The encoder calls it between compressing and writing. */
static exr_result_t await_turn(exr_encode_pipeline_t *encoder)
{
    struct chunk_queue *queue = encoder->encoding_user_data;
    pthread_mutex_lock(&queue->lock);
    while (queue->code == EXR_ERR_SUCCESS &&
           queue->written + queue->image->window.top != (size_t)encoder->chunk.start_y)
        pthread_cond_wait(&queue->moved, &queue->lock);
    exr_result_t code = queue->code;
    pthread_mutex_unlock(&queue->lock);
    return code;
}

static void end_turn(struct chunk_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->written += queue->lines;
    pthread_cond_broadcast(&queue->moved);
    pthread_mutex_unlock(&queue->lock);
}

/* Stands in for the library's own writing of a chunk. Readers take a chunk as long as its pixels
 * for uncompressed, but the library (openexr issue 2306) stores the ZIP stream
 * also where it happens to have just that length: two in a hundred tiny pictures came back as
 * noise. */
static exr_result_t write_shorter(exr_encode_pipeline_t *encoder)
{
    struct chunk_queue *queue = encoder->encoding_user_data;
    const void *bytes = encoder->compressed_bytes < encoder->packed_bytes
                            ? encoder->compressed_buffer
                            : encoder->packed_buffer;
    exr_result_t code = exr_write_scanline_chunk(queue->context, PART, encoder->chunk.start_y,
                                                 bytes, encoder->compressed_bytes);
    if (code == EXR_ERR_SUCCESS)
        end_turn(queue);
    return code;
}

static exr_result_t write_chunk(struct chunk_queue *queue, exr_encode_pipeline_t *encoder,
                                size_t line)
{
    exr_context_t context = queue->context;
    exr_chunk_info_t chunk;
    bool first = !encoder->context;
    exr_result_t code = exr_write_scanline_chunk_info(
        context, PART, (int)(queue->image->window.top + line), &chunk);
    if (code == EXR_ERR_SUCCESS) {
        code = first ? exr_encoding_initialize(context, PART, &chunk, encoder)
                     : exr_encoding_update(context, PART, &chunk, encoder);
    }
    if (code != EXR_ERR_SUCCESS)
        return code;
    point_at_line(encoder, queue->image, line);
    if (first) {
        code = exr_encoding_choose_default_routines(context, PART, encoder);
        encoder->encoding_user_data = queue;
        encoder->yield_until_ready_fn = await_turn;
        encoder->write_fn = write_shorter;
    }
    return code == EXR_ERR_SUCCESS ? exr_encoding_run(context, PART, encoder) : code;
}

static void work_off_chunks(void *user, uint64_t index, uint32_t worker)
{
    (void)index;
    (void)worker;
    struct chunk_queue *queue = user;
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = EXR_ERR_SUCCESS;
    for (size_t line; code == EXR_ERR_SUCCESS && take_chunk(queue, &line);)
        code = write_chunk(queue, &encoder, line);
    if (code != EXR_ERR_SUCCESS)
        give_up(queue, code);
    exr_encoding_destroy(queue->context, &encoder);
}

static ps_result write_chunks(exr_context_t context, const struct image *image, size_t lines,
                              struct workers *workers, const struct exr_sink *sink)
{
    struct chunk_queue queue = {
        .context = context, .image = image, .lines = lines, .code = EXR_ERR_SUCCESS};
    pthread_mutex_init(&queue.lock, NULL);
    pthread_cond_init(&queue.moved, NULL);
    parallel_for(workers, workers_count(workers), work_off_chunks, &queue);
    pthread_cond_destroy(&queue.moved);
    pthread_mutex_destroy(&queue.lock);
    return explain(sink, queue.code, "the", "pixels");
}

static ps_result write_picture(const struct image *image, enum image_compression compression,
                               struct workers *workers, struct exr_sink *sink)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = drop_message;
    setup.user_data = sink;
    setup.write_fn = write_bytes;
    exr_context_t context = NULL;
    ps_result result =
        explain(sink, exr_start_write(&context, sink->file.path, EXR_WRITE_FILE_DIRECTLY, &setup),
                "the", "start");
    if (result != PS_OK)
        return result;
    result = write_header(context, image, compression, sink);
    if (result == PS_OK)
        result = write_chunks(context, image, compressions[compression].lines, workers, sink);
    exr_result_t code = exr_finish(&context);
    return result == PS_OK ? explain(sink, code, "the", "end") : result;
}

bool image_compression_named(const char *name, enum image_compression *compression)
{
    for (size_t i = 0; i < sizeof compressions / sizeof compressions[0]; i++)
        if (strcmp(name, compressions[i].name) == 0) {
            *compression = (enum image_compression)i;
            return true;
        }
    return false;
}

ps_result image_write_exr(const struct image *image, const char *path,
                          enum image_compression compression, struct workers *workers,
                          struct error *error)
{
    struct exr_sink sink = {.error = error};
    ps_result result = check_picture(image, path, error);
    if (result == PS_OK)
        result = output_file_open(&sink.file, path, error);
    if (result != PS_OK)
        return result;
    result = write_picture(image, compression, workers, &sink);
    if (result != PS_OK) {
        output_file_discard(&sink.file);
        return result;
    }
    return output_file_commit(&sink.file, error);
}
