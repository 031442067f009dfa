/* exr_write.c: a picture to a scan-line OpenEXR file, through the library's C interface.
 *
 * The order of calls matters and is written down nowhere: start, add the part, required attributes,
 * channels, other attributes, header; then for each chunk its information, the encoder (initialised
 * with the first chunk, updated with the others), the planes' pointers *moved to that chunk's first
 * line*, and the run; then finish. Bytes go through output_file rather than the library's own file
 * handling, so that the file appears whole and a failed write says why.
 *
 * The library's messages are dropped: its handler runs with the context locked while writing, so it
 * cannot ask for our data; result codes with what was being written tell as much. No capDate: the
 * same picture gives the same bytes.
 */
#include "image/image.h"
#include "image/output_file.h"

#include <OpenEXR/openexr.h>
#include <stdbool.h>
#include <string.h>

#define LINES_PER_CHUNK 16   /* of ZIP compression */
#define SHORT_NAME_LENGTH 31 /* longer names need a flag that readers before 2012 lack */
#define PART 0               /* the file's only part */
#define SAMPLE_SIZE ((int32_t)sizeof(float))

/* ITU-R BT.709-6: x and y of red, green, blue, and of white (D65). */
static const exr_attr_chromaticities_t rec709 = {0.64f, 0.33f, 0.30f,   0.60f,
                                                 0.15f, 0.06f, 0.3127f, 0.3290f};

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
    if (code == EXR_ERR_SUCCESS) {
        return PS_OK;
    }
    if (sink->failed) {
        return PS_ERROR_IO;
    }
    return error_set(sink->error,
                     code == EXR_ERR_OUT_OF_MEMORY ? PS_ERROR_MEMORY : PS_ERROR_INVALID,
                     "cannot write '%s' (%s %s): %s", sink->file.path, kind, name,
                     exr_get_default_error_message(code));
}

/* What the format, or the library's 32-bit sizes, cannot hold. */
static ps_result check_picture(const struct image *image, const char *path, struct error *error)
{
    if (image->width == 0 || image->height == 0 || image->channel_count == 0) {
        return error_set(error, PS_ERROR_INVALID, "cannot write '%s': the picture is empty", path);
    }
    size_t bytes_per_column = image->channel_count * LINES_PER_CHUNK * sizeof(float);
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
    for (size_t i = 0; i < image->channel_count; i++) {
        needed = needed || strlen(image->channels[i].name) > SHORT_NAME_LENGTH;
    }
    for (size_t i = 0; i < image->attribute_count; i++) {
        needed = needed || strlen(image->attributes[i].name) > SHORT_NAME_LENGTH;
    }
    return needed;
}

static ps_result write_header(exr_context_t context, const struct image *image,
                              const struct exr_sink *sink)
{
    exr_result_t code = exr_set_longname_support(context, needs_long_names(image));
    if (code == EXR_ERR_SUCCESS) {
        code = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, NULL);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = exr_initialize_required_attr_simple(context, PART, (int32_t)image->width,
                                                   (int32_t)image->height, EXR_COMPRESSION_ZIP);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = exr_attr_set_chromaticities(context, PART, "chromaticities", &rec709);
    }
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
    if (result != PS_OK) {
        return result;
    }
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

/* Stands in for the library's own writing of a chunk. Readers take a chunk as long as its pixels
 * for uncompressed, but the library (openexr issue 2306) stores the ZIP stream
 * also where it happens to have just that length: two in a hundred tiny pictures came back as
 * noise. */
static exr_result_t write_shorter(exr_encode_pipeline_t *encoder)
{
    exr_context_t context = encoder->encoding_user_data;
    const void *bytes = encoder->compressed_bytes < encoder->packed_bytes
                            ? encoder->compressed_buffer
                            : encoder->packed_buffer;
    return exr_write_scanline_chunk(context, PART, encoder->chunk.start_y, bytes,
                                    encoder->compressed_bytes);
}

static exr_result_t write_chunk(exr_context_t context, exr_encode_pipeline_t *encoder,
                                const struct image *image, size_t line)
{
    exr_chunk_info_t chunk;
    exr_result_t code = exr_write_scanline_chunk_info(context, PART, (int)line, &chunk);
    if (code != EXR_ERR_SUCCESS) {
        return code;
    }
    code = line == 0 ? exr_encoding_initialize(context, PART, &chunk, encoder)
                     : exr_encoding_update(context, PART, &chunk, encoder);
    if (code != EXR_ERR_SUCCESS) {
        return code;
    }
    point_at_line(encoder, image, line);
    if (line == 0) {
        code = exr_encoding_choose_default_routines(context, PART, encoder);
        encoder->encoding_user_data = context;
        encoder->write_fn = write_shorter;
    }
    return code == EXR_ERR_SUCCESS ? exr_encoding_run(context, PART, encoder) : code;
}

static ps_result write_chunks(exr_context_t context, const struct image *image,
                              const struct exr_sink *sink)
{
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = EXR_ERR_SUCCESS;
    for (size_t line = 0; line < image->height && code == EXR_ERR_SUCCESS;
         line += LINES_PER_CHUNK) {
        code = write_chunk(context, &encoder, image, line);
    }
    exr_encoding_destroy(context, &encoder);
    return explain(sink, code, "the", "pixels");
}

static ps_result write_picture(const struct image *image, struct exr_sink *sink)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = drop_message;
    setup.user_data = sink;
    setup.write_fn = write_bytes;
    exr_context_t context = NULL;
    ps_result result =
        explain(sink, exr_start_write(&context, sink->file.path, EXR_WRITE_FILE_DIRECTLY, &setup),
                "the", "start");
    if (result != PS_OK) {
        return result;
    }
    result = write_header(context, image, sink);
    if (result == PS_OK) {
        result = write_chunks(context, image, sink);
    }
    exr_result_t code = exr_finish(&context);
    return result == PS_OK ? explain(sink, code, "the", "end") : result;
}

ps_result image_write_exr(const struct image *image, const char *path, struct error *error)
{
    struct exr_sink sink = {.error = error};
    ps_result result = check_picture(image, path, error);
    if (result == PS_OK) {
        result = output_file_open(&sink.file, path, error);
    }
    if (result != PS_OK) {
        return result;
    }
    result = write_picture(image, &sink);
    if (result != PS_OK) {
        output_file_discard(&sink.file);
        return result;
    }
    return output_file_commit(&sink.file, error);
}
