/* exr_header.c: which part and channels of an OpenEXR file are read, and whether it can be what its
 * header says.
 *
 * Of several parts, for rasters alone, the first with colours is read, or that of a layer.
 */
#include "image/exr_layer.h"
#include "image/exr_source.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#define PIXEL_LIMIT (INT64_C(1) << 31)
#define CHANNEL_LIMIT INT16_MAX /* the library's decoder counts them in 16 bits */

/* At most so many bytes come out of one: what deflate can do, by the quarter that PXR24 drops of a
 * float (runs and PIZ reach less); and, for DWA, deflate on one half of a block of 64. */
#define FLOAT_EXPANSION (RASTER_DEFLATE_EXPANSION * 4 / 3)
#define BLOCK_EXPANSION (RASTER_DEFLATE_EXPANSION * 64)

/* How a message of a picture's file starts. */
static const char *before_path(const struct exr_source *source)
{
    return source->memory ? "" : "cannot read '";
}

static const char *after_path(const struct exr_source *source)
{
    return source->memory ? ": " : "': ";
}

ps_result exr_source_explain(const struct exr_source *source, exr_result_t code)
{
    if (code == EXR_ERR_SUCCESS)
        return PS_OK;
    return error_set(source->error, code == EXR_ERR_OUT_OF_MEMORY ? PS_ERROR_MEMORY : PS_ERROR_IO,
                     "%s%s%s%s", before_path(source), source->path, after_path(source),
                     source->message[0] ? source->message : exr_get_default_error_message(code));
}

ps_result exr_source_refuse(const struct exr_source *source, const char *why)
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
        return exr_source_refuse(source,
                                 "B44 compression cannot be read (convert the file to ZIP)");
    }
    return exr_source_explain(source, code);
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

/* A header of a few hundred bytes may claim gigabytes, which nobody should have to allocate
 * first. */
static ps_result check_expansion(const struct exr_source *source)
{
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    const exr_attr_chlist_t *list = NULL;
    exr_result_t code = exr_get_compression(source->context, source->part, &compression);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_channels(source->context, source->part, &list);
    if (code != EXR_ERR_SUCCESS)
        return exr_source_explain(source, code);
    uint64_t pixel_bytes = 0;
    for (int i = 0; i < list->num_channels; i++)
        pixel_bytes += list->entries[i].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    bool blocks = compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB;
    uint64_t decoded = (uint64_t)source->image.width * source->height * pixel_bytes;
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

static ps_result check_form(struct exr_source *source)
{
    int parts = 0;
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    exr_result_t code = exr_get_count(source->context, &parts);
    if (code == EXR_ERR_SUCCESS && parts != 1 && !source->memory)
        return exr_source_refuse(source, "it has several parts (only one can be read)");
    choose_part(source, parts);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_storage(source->context, source->part, &storage);
    if (code != EXR_ERR_SUCCESS)
        return exr_source_explain(source, code);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return exr_source_refuse(source, "it holds deep pixels (only flat ones can be read)");
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
    source->facts.pixels = (uint64_t)source->image.width * source->height;
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

/* Where the picture lies in the display window, if it does and that begins at (0, 0); else it is
 * all there is. */
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
        return exr_source_explain(source, code);
    const exr_attr_box2i_t *window = &source->window;
    int64_t width = (int64_t)window->max.x - window->min.x + 1;
    int64_t height = (int64_t)window->max.y - window->min.y + 1;
    if (width <= 0 || height <= 0 || width > INT32_MAX / (int64_t)sizeof(float) ||
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
    source->height = source->image.height = (size_t)height;
    exr_result_t place = read_place(source);
    return exr_source_explain(source, place == EXR_ERR_SUCCESS ? read_facts(source) : place);
}

/* Lines of a chunk; of those there are as many side by side as it takes. */
static ps_result read_chunk_lines(struct exr_source *source)
{
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    uint32_t width = 0, height = 0;
    int32_t lines = 0;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    exr_result_t code = exr_get_storage(source->context, source->part, &storage);
    if (code == EXR_ERR_SUCCESS && storage == EXR_STORAGE_TILED)
        code = exr_get_tile_descriptor(source->context, source->part, &width, &height, &levels,
                                       &rounding);
    else if (code == EXR_ERR_SUCCESS)
        code = exr_get_scanlines_per_chunk(source->context, source->part, &lines);
    if (code != EXR_ERR_SUCCESS)
        return exr_source_explain(source, code);
    if (storage == EXR_STORAGE_TILED && (width == 0 || height == 0))
        return exr_source_refuse(source, "its tiles have no size");
    source->tile_width = width;
    source->band_lines = storage == EXR_STORAGE_TILED ? height : (size_t)lines;
    if (source->bands && source->band_lines < source->height)
        source->image.height = source->band_lines;
    return PS_OK;
}

static ps_result add_channels(struct exr_source *source)
{
    const exr_attr_chlist_t *list = NULL;
    exr_result_t code = exr_get_channels(source->context, source->part, &list);
    if (code != EXR_ERR_SUCCESS)
        return exr_source_explain(source, code);
    if (list->num_channels <= 0 || list->num_channels > CHANNEL_LIMIT)
        return exr_source_refuse(source, "it has no channels, or too many");
    source->facts.halves = true;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return exr_source_refuse(source, "it has subsampled channels");
        if (image_channel(&source->image, entry->name.str))
            return exr_source_refuse(source, "it has two channels of one name");
        if (!is_wanted(source, entry->name.str))
            continue;
        source->facts.halves &= entry->pixel_type == EXR_PIXEL_HALF;
        if (!image_add_channel(&source->image, entry->name.str)) {
            return error_set(source->error, PS_ERROR_MEMORY,
                             "%s%s%sout of memory for %zu x %zu pixels of %d channels",
                             before_path(source), source->path, after_path(source),
                             source->image.width, source->height, list->num_channels);
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
    return exr_source_explain(source, code);
}

/* Without the picture's own channels the file is read to its end, and the caller says what is
 * missing. */
static ps_result check_layer(const struct exr_source *source)
{
    char layers[256];
    if (source->image.channel_count > 0 || !source->memory || !source->memory->layer)
        return PS_OK;
    exr_layer_list(source->context, layers, sizeof layers);
    return error_set(source->error, PS_ERROR_INVALID, "%s: it has no layer '%s'; it has %s",
                     source->path, source->memory->layer, layers);
}

ps_result exr_header_read(struct exr_source *source)
{
    ps_result result = check_form(source);
    if (result == PS_OK)
        result = read_size(source);
    if (result == PS_OK)
        result = check_expansion(source);
    if (result == PS_OK)
        result = read_chunk_lines(source);
    if (result == PS_OK)
        result = add_channels(source);
    if (result == PS_OK)
        result = check_layer(source);
    return result == PS_OK ? add_attributes(source) : result;
}
