/* exr_read.c: a flat OpenEXR file to a picture, through the library's C interface.
 *
 * The picture is the data window, wherever that lies; the image says where. Chunks (groups of lines, or tiles) are
 * decoded straight into the planes, which the library converts to float on the way. It could also
 * search a damaged file for chunks that its table does not list; that is switched off, because half
 * a picture that looks whole is worse than an error. The first of the library's messages is the one
 * shown: the later ones follow from it. Rasters are read from memory, others from their file. Of tiles in several levels
 * the largest is read; of several parts, for rasters alone, the first with colours, or that of a layer.
 */
#include "image/exr_layer.h"
#include "image/raster_decode.h"

#include <OpenEXR/openexr.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define PIXEL_LIMIT (INT64_C(1) << 31)
#define CHANNEL_LIMIT INT16_MAX /* the library's decoder counts them in 16 bits */
#define SAMPLE_SIZE ((int32_t)sizeof(float))

/* At most so many bytes come out of one: what deflate can do, by the quarter that PXR24 drops of a
 * float (runs and PIZ reach less); and, for DWA, deflate on one half of a block of 64. */
#define FLOAT_EXPANSION (RASTER_DEFLATE_EXPANSION * 4 / 3)
#define BLOCK_EXPANSION (RASTER_DEFLATE_EXPANSION * 64)

struct exr_source {
    exr_context_t context;
    int part;
    const char *path;
    const struct raster_source *memory; /* NULL: from the file, with all channels */
    struct error *error;
    char message[256]; /* the library's first complaint, or empty */
    struct image image;
    exr_decode_pipeline_t decoder;
    bool decoding; /* the decoder has been initialised */
    exr_attr_box2i_t window;
    struct exr_facts facts;
    float
        *spare; /* where channels go that are not wanted: the library crashes if told to skip one */
    size_t spare_count;
};

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

/* How a message of a picture's file starts. */
static const char *before_path(const struct exr_source *source)
{
    return source->memory ? "" : "cannot read '";
}

static const char *after_path(const struct exr_source *source)
{
    return source->memory ? ": " : "': ";
}

static ps_result explain(const struct exr_source *source, exr_result_t code)
{
    if (code == EXR_ERR_SUCCESS)
        return PS_OK;
    return error_set(source->error, code == EXR_ERR_OUT_OF_MEMORY ? PS_ERROR_MEMORY : PS_ERROR_IO,
                     "%s%s%s%s", before_path(source), source->path, after_path(source),
                     source->message[0] ? source->message : exr_get_default_error_message(code));
}

static ps_result refuse(const struct exr_source *source, const char *why)
{
    return error_set(source->error, PS_ERROR_INVALID, "%s%s%s%s", before_path(source), source->path,
                     after_path(source), why);
}

/* B44 and B44A come out as noise for some channel types and tile sizes (measured against the C++
 * library, 3.1.5), without an error; all other compressions agree to the bit. */
static ps_result check_compression(const struct exr_source *source)
{
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    exr_result_t code = exr_get_compression(source->context, source->part, &compression);
    if (code == EXR_ERR_SUCCESS &&
        (compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A)) {
        return refuse(source, "B44 compression cannot be read (convert the file to ZIP)");
    }
    return explain(source, code);
}

/* What is no regular file may be of any size. */
static ps_result check_expansion_of_file(const struct exr_source *source, uint64_t decoded,
                                         uint64_t expansion)
{
    struct stat status;
    char beginning[sizeof source->error->text];
    if (stat(source->path, &status) != 0 || !S_ISREG(status.st_mode))
        return PS_OK;
    snprintf(beginning, sizeof beginning, "%s%s'", before_path(source), source->path);
    const struct raster_source file = {.path = beginning, .size = (size_t)status.st_size};
    return raster_check_expansion(&file, decoded, expansion, source->error);
}

/* A header of a few hundred bytes may claim gigabytes, which nobody should have to allocate first. */
static ps_result check_expansion(const struct exr_source *source)
{
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    const exr_attr_chlist_t *list = NULL;
    exr_result_t code = exr_get_compression(source->context, source->part, &compression);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_channels(source->context, source->part, &list);
    if (code != EXR_ERR_SUCCESS)
        return explain(source, code);
    uint64_t pixel_bytes = 0;
    for (int i = 0; i < list->num_channels; i++)
        pixel_bytes += list->entries[i].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    bool blocks = compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB;
    uint64_t decoded = (uint64_t)source->image.width * source->image.height * pixel_bytes;
    uint64_t expansion = blocks ? BLOCK_EXPANSION : FLOAT_EXPANSION;
    return source->memory
               ? raster_check_expansion(source->memory, decoded, expansion, source->error)
               : check_expansion_of_file(source, decoded, expansion);
}

static bool is_wanted(const struct exr_source *source, const char *name)
{
    return !source->memory ||
           exr_layer_wants(source->memory->layer, source->facts.layer_is_part, name);
}

/* What a channel is called in its layer. */
static const char *suffix_of(const struct exr_source *source, const char *name)
{
    bool is_prefix = source->memory && !source->facts.layer_is_part;
    const char *suffix = exr_layer_suffix(is_prefix ? source->memory->layer : NULL, name);
    return suffix ? suffix : name;
}

/* Whether a part has more of the channels that are wanted than alpha, and flat pixels. */
static bool has_wanted(const struct exr_source *source, int part)
{
    const exr_attr_chlist_t *list = NULL;
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    if (exr_get_storage(source->context, part, &storage) != EXR_ERR_SUCCESS ||
        (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) ||
        exr_get_channels(source->context, part, &list) != EXR_ERR_SUCCESS)
        return false;
    for (int i = 0; i < list->num_channels; i++)
        if (is_wanted(source, list->entries[i].name.str) &&
            strcmp(suffix_of(source, list->entries[i].name.str), "A") != 0)
            return true;
    return false;
}

static bool is_called(const struct exr_source *source, int part, const char *name)
{
    const char *own = NULL;
    return exr_get_name(source->context, part, &own) == EXR_ERR_SUCCESS && own &&
           strcmp(own, name) == 0;
}

/* The first part with channels of the layer, or else the first of that name. */
static void choose_part(struct exr_source *source, int parts)
{
    const char *layer = source->memory ? source->memory->layer : NULL;
    bool found = false;
    for (int i = 0; i < parts && !found; i++) {
        found = has_wanted(source, i);
        if (found)
            source->part = i;
    }
    source->facts.layer_is_part = !found && layer;
    for (int i = 0; i < parts && layer && !found; i++) {
        found = is_called(source, i, layer) && has_wanted(source, i);
        if (found)
            source->part = i;
    }
    source->facts.layer_is_part = source->facts.layer_is_part && found;
    source->message[0] = '\0'; /* that a part has no name */
}

static ps_result check_form(struct exr_source *source, exr_storage_t *storage)
{
    int parts = 0;
    exr_result_t code = exr_get_count(source->context, &parts);
    if (code == EXR_ERR_SUCCESS && parts != 1 && !source->memory)
        return refuse(source, "it has several parts (only one can be read)");
    choose_part(source, parts);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_storage(source->context, source->part, storage);
    if (code != EXR_ERR_SUCCESS)
        return explain(source, code);
    if (*storage != EXR_STORAGE_SCANLINE && *storage != EXR_STORAGE_TILED)
        return refuse(source, "it holds deep pixels (only flat ones can be read)");
    return check_compression(source);
}

/* Where the data window lies in the display window, and by which primaries colours are stated. */
static exr_result_t read_facts(struct exr_source *source)
{
    exr_attr_box2i_t display, data = source->window;
    exr_attr_chromaticities_t c;
    exr_result_t code = exr_get_display_window(source->context, source->part, &display);
    if (code != EXR_ERR_SUCCESS)
        return code;
    source->facts.left = (int64_t)data.min.x - display.min.x;
    source->facts.top = (int64_t)data.min.y - display.min.y;
    source->facts.width = (int64_t)display.max.x - display.min.x + 1;
    source->facts.height = (int64_t)display.max.y - display.min.y + 1;
    source->facts.has_chromaticities =
        exr_attr_get_chromaticities(source->context, source->part, "chromaticities", &c) ==
        EXR_ERR_SUCCESS;
    if (source->facts.has_chromaticities)
        source->facts.chromaticities = (struct chromaticities){{c.red_x, c.red_y},
                                                               {c.green_x, c.green_y},
                                                               {c.blue_x, c.blue_y},
                                                               {c.white_x, c.white_y}};
    source->message[0] = '\0'; /* that there are none */
    return code;
}

/* Where the picture lies in the display window, if it does and that begins at (0, 0); else it is all there is. */
static exr_result_t read_place(struct exr_source *source)
{
    exr_attr_box2i_t display, data = source->window;
    struct image *image = &source->image;
    image->window = (struct picture_window){0, 0, image->width, image->height};
    exr_result_t code = exr_get_display_window(source->context, source->part, &display);
    if (code == EXR_ERR_SUCCESS && display.min.x == 0 && display.min.y == 0 && data.min.x >= 0 &&
        data.min.y >= 0 && display.max.x >= data.max.x && display.max.y >= data.max.y)
        image->window =
            (struct picture_window){(size_t)data.min.x, (size_t)data.min.y,
                                    (size_t)display.max.x + 1, (size_t)display.max.y + 1};
    return code;
}

static ps_result read_size(struct exr_source *source)
{
    exr_result_t code = exr_get_data_window(source->context, source->part, &source->window);
    if (code != EXR_ERR_SUCCESS)
        return explain(source, code);
    const exr_attr_box2i_t *window = &source->window;
    int64_t width = (int64_t)window->max.x - window->min.x + 1;
    int64_t height = (int64_t)window->max.y - window->min.y + 1;
    if (width <= 0 || height <= 0 || width > INT32_MAX / SAMPLE_SIZE ||
        width > PIXEL_LIMIT / height) {
        return error_set(source->error, PS_ERROR_INVALID, "%s%s%sits size, %lld x %lld, cannot be",
                         before_path(source), source->path, after_path(source), (long long)width,
                         (long long)height);
    }
    if (source->memory) {
        ps_result result =
            raster_check_size(source->path, width, height, 4 * sizeof(float), source->error);
        if (result != PS_OK)
            return result;
    }
    source->image.width = (size_t)width;
    source->image.height = (size_t)height;
    exr_result_t place = read_place(source);
    return explain(source, place == EXR_ERR_SUCCESS ? read_facts(source) : place);
}

static ps_result add_channels(struct exr_source *source)
{
    const exr_attr_chlist_t *list = NULL;
    exr_result_t code = exr_get_channels(source->context, source->part, &list);
    if (code != EXR_ERR_SUCCESS)
        return explain(source, code);
    if (list->num_channels <= 0 || list->num_channels > CHANNEL_LIMIT)
        return refuse(source, "it has no channels, or too many");
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return refuse(source, "it has subsampled channels");
        if (image_channel(&source->image, entry->name.str))
            return refuse(source, "it has two channels of one name");
        if (!is_wanted(source, entry->name.str))
            continue;
        if (!image_add_channel(&source->image, entry->name.str)) {
            return error_set(source->error, PS_ERROR_MEMORY,
                             "%s%s%sout of memory for %zu x %zu pixels of %d channels",
                             before_path(source), source->path, after_path(source),
                             source->image.width, source->image.height, list->num_channels);
        }
    }
    return PS_OK;
}

/* "type" repeats the storage, which the picture no longer has. */
static ps_result add_attributes(struct exr_source *source)
{
    int32_t count = 0;
    exr_result_t code = exr_get_attribute_count(source->context, source->part, &count);
    for (int32_t i = 0; i < count && code == EXR_ERR_SUCCESS; i++) {
        const exr_attribute_t *attribute = NULL;
        code = exr_get_attribute_by_index(source->context, source->part, EXR_ATTR_LIST_FILE_ORDER,
                                          i, &attribute);
        if (code != EXR_ERR_SUCCESS || attribute->type != EXR_ATTR_STRING ||
            strcmp(attribute->name, "type") == 0) {
            continue;
        }
        const char *value = attribute->string->str;
        ps_result result =
            image_set_attribute(&source->image, attribute->name, value ? value : "", source->error);
        if (result != PS_OK)
            return result;
    }
    return explain(source, code);
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

/* Tells the decoder where the channels of a chunk go whose upper left pixel in the picture is
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

/* Decodes the chunk whose upper left pixel in the picture is (column, line). */
static exr_result_t decode_chunk(struct exr_source *source, const exr_chunk_info_t *chunk,
                                 size_t column, size_t line)
{
    const struct image *image = &source->image;
    exr_decode_pipeline_t *decoder = &source->decoder;
    if (chunk->width <= 0 || chunk->height <= 0 || (size_t)chunk->width > image->width - column ||
        (size_t)chunk->height > image->height - line) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    bool first = !source->decoding;
    exr_result_t code = first
                            ? exr_decoding_initialize(source->context, source->part, chunk, decoder)
                            : exr_decoding_update(source->context, source->part, chunk, decoder);
    if (code == EXR_ERR_SUCCESS) {
        source->decoding = true;
        code = provide_spare(source, chunk);
    }
    if (code != EXR_ERR_SUCCESS)
        return code;
    direct_channels(source, chunk, column, line);
    if (first)
        code = exr_decoding_choose_default_routines(source->context, source->part, decoder);
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(source->context, source->part, decoder)
                                   : code;
}

static ps_result read_lines(struct exr_source *source)
{
    int32_t lines_per_chunk = 0;
    exr_result_t code =
        exr_get_scanlines_per_chunk(source->context, source->part, &lines_per_chunk);
    for (size_t line = 0; line < source->image.height && code == EXR_ERR_SUCCESS;
         line += (size_t)lines_per_chunk) {
        exr_chunk_info_t chunk;
        int row = (int)(source->window.min.y + (int64_t)line);
        code = exr_read_scanline_chunk_info(source->context, source->part, row, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = decode_chunk(source, &chunk, 0, line);
    }
    return explain(source, code);
}

static ps_result read_tiles(struct exr_source *source)
{
    uint32_t width = 0, height = 0;
    exr_tile_level_mode_t levels = EXR_TILE_ONE_LEVEL;
    exr_tile_round_mode_t rounding;
    exr_result_t code =
        exr_get_tile_descriptor(source->context, source->part, &width, &height, &levels, &rounding);
    if (code == EXR_ERR_SUCCESS && (width == 0 || height == 0))
        return refuse(source, "its tiles have no size");
    for (size_t line = 0; line < source->image.height && code == EXR_ERR_SUCCESS; line += height) {
        for (size_t column = 0; column < source->image.width && code == EXR_ERR_SUCCESS;
             column += width) {
            exr_chunk_info_t chunk;
            code = exr_read_tile_chunk_info(source->context, source->part, (int)(column / width),
                                            (int)(line / height), 0, 0, &chunk);
            if (code == EXR_ERR_SUCCESS)
                code = decode_chunk(source, &chunk, column, line);
        }
    }
    return explain(source, code);
}

/* Without the picture's own channels the file is read to its end, and the caller says what is missing. */
static ps_result check_layer(const struct exr_source *source)
{
    char layers[256];
    if (source->image.channel_count > 0 || !source->memory || !source->memory->layer)
        return PS_OK;
    exr_layer_list(source->context, layers, sizeof layers);
    return error_set(source->error, PS_ERROR_INVALID, "%s: it has no layer '%s'; it has %s",
                     source->path, source->memory->layer, layers);
}

static ps_result read_picture(struct exr_source *source)
{
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    ps_result result = check_form(source, &storage);
    if (result == PS_OK)
        result = read_size(source);
    if (result == PS_OK)
        result = check_expansion(source);
    if (result == PS_OK)
        result = add_channels(source);
    if (result == PS_OK)
        result = check_layer(source);
    if (result == PS_OK)
        result = add_attributes(source);
    if (result != PS_OK || source->image.channel_count == 0)
        return result;
    result = storage == EXR_STORAGE_TILED ? read_tiles(source) : read_lines(source);
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
    ps_result result = explain(source, exr_start_read(&source->context, source->path, &setup));
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

ps_result exr_read_layer(const struct raster_source *memory, struct image *image,
                         struct exr_facts *facts, struct error *error)
{
    struct exr_source source = {.path = memory->path, .memory = memory, .error = error};
    ps_result result = read_source(&source, image);
    *facts = source.facts;
    return result;
}
