#include "image/exr_output.h"

#include <string.h>

#define MOST_LINES 16        /* of a chunk */
#define SHORT_NAME_LENGTH 31 /* longer names need a flag that readers before 2012 lack */

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

size_t exr_output_lines(enum image_compression compression)
{
    return compressions[compression].lines;
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

static void drop_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static int64_t write_bytes(exr_const_context_t context, void *user_data, const void *bytes,
                           uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t report)
{
    struct exr_output *output = user_data;
    (void)context;
    (void)report;
    if (output_file_write(&output->file, offset, bytes, (size_t)size, output->error) != PS_OK) {
        output->failed = true;
        return -1;
    }
    return (int64_t)size;
}

ps_result exr_output_explain(const struct exr_output *output, exr_result_t code, const char *kind,
                             const char *name)
{
    if (code == EXR_ERR_SUCCESS)
        return PS_OK;
    if (output->failed)
        return PS_ERROR_IO;
    return error_set(output->error,
                     code == EXR_ERR_OUT_OF_MEMORY ? PS_ERROR_MEMORY : PS_ERROR_INVALID,
                     "cannot write '%s' (%s %s): %s", output->file.path, kind, name,
                     exr_get_default_error_message(code));
}

/* --- the header
 * -------------------------------------------------------------------------------- */

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

/* Tiles may come in any order. */
static exr_result_t set_windows(exr_context_t context, const struct image *image, uint32_t tile,
                                exr_compression_t compression)
{
    const struct picture_window *window = &image->window;
    exr_attr_box2i_t data = box(window->left, window->top, image->width, image->height);
    exr_attr_box2i_t display =
        window->picture_width > 0 ? box(0, 0, window->picture_width, window->picture_height) : data;
    exr_attr_v2f_t center;
    center.x = center.y = 0.0f;
    exr_result_t code = exr_initialize_required_attr(
        context, EXR_OUTPUT_PART, &display, &data, 1.0f, &center, 1.0f,
        tile > 0 ? EXR_LINEORDER_RANDOM_Y : EXR_LINEORDER_INCREASING_Y, compression);
    return code == EXR_ERR_SUCCESS && tile > 0
               ? exr_set_tile_descriptor(context, EXR_OUTPUT_PART, tile, tile, EXR_TILE_ONE_LEVEL,
                                         EXR_TILE_ROUND_DOWN)
               : code;
}

static ps_result write_header(const struct exr_output *output, const struct image *image,
                              uint32_t tile, enum image_compression compression)
{
    exr_context_t context = output->context;
    exr_result_t code = exr_set_longname_support(context, needs_long_names(image));
    if (code == EXR_ERR_SUCCESS)
        code =
            exr_add_part(context, NULL, tile > 0 ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, NULL);
    if (code == EXR_ERR_SUCCESS) {
        code = set_windows(context, image, tile, compressions[compression].code);
    }
    if (code == EXR_ERR_SUCCESS)
        code = exr_set_zip_compression_level(context, EXR_OUTPUT_PART, ZIP_LEVEL);
    if (code == EXR_ERR_SUCCESS)
        code = exr_attr_set_chromaticities(context, EXR_OUTPUT_PART, "chromaticities", &rec709);
    ps_result result = exr_output_explain(output, code, "the", "header");
    for (size_t i = 0; i < image->channel_count && result == PS_OK; i++) {
        const char *name = image->channels[i].name;
        code = exr_add_channel(context, EXR_OUTPUT_PART, name, EXR_PIXEL_FLOAT,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
        result = exr_output_explain(output, code, "channel", name);
    }
    for (size_t i = 0; i < image->attribute_count && result == PS_OK; i++) {
        const struct image_attribute *attribute = &image->attributes[i];
        code = exr_attr_set_string(context, EXR_OUTPUT_PART, attribute->name, attribute->value);
        result = exr_output_explain(output, code, "attribute", attribute->name);
    }
    if (result != PS_OK)
        return result;
    return exr_output_explain(output, exr_write_header(context), "the", "header");
}

/* --- the file
 * ---------------------------------------------------------------------------------- */

static ps_result start(struct exr_output *output, const struct image *image, uint32_t tile,
                       enum image_compression compression)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = drop_message;
    setup.user_data = output;
    setup.write_fn = write_bytes;
    ps_result result = exr_output_explain(
        output,
        exr_start_write(&output->context, output->file.path, EXR_WRITE_FILE_DIRECTLY, &setup),
        "the", "start");
    return result == PS_OK ? write_header(output, image, tile, compression) : result;
}

ps_result exr_output_open(struct exr_output *output, const char *path, const struct image *image,
                          uint32_t tile, enum image_compression compression, struct error *error)
{
    *output = (struct exr_output){.error = error};
    ps_result result = check_picture(image, path, error);
    if (result == PS_OK)
        result = output_file_open(&output->file, path, error);
    if (result != PS_OK)
        return result;
    result = start(output, image, tile, compression);
    return result == PS_OK ? PS_OK : exr_output_close(output, result, error);
}

ps_result exr_output_close(struct exr_output *output, ps_result result, struct error *error)
{
    output->error = error;
    exr_result_t code = output->context ? exr_finish(&output->context) : EXR_ERR_SUCCESS;
    if (result == PS_OK)
        result = exr_output_explain(output, code, "the", "end");
    if (result == PS_OK)
        return output_file_commit(&output->file, error);
    output_file_discard(&output->file);
    return result;
}
