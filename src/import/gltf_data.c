/* gltf_data.c: from the JSON to the bytes, each bound checked.
 *
 * A buffer's file, or the bytes of its data URI, are kept until the import's end; a binary file's
 * own buffer is looked up each time, since the file's bytes may move.
 */
#include "import/gltf_data.h"

#include "base/path.h"
#include "import/text.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define LONGEST_PATH 4096

ps_result gltf_refuse(struct error *error, const char *what)
{
    return error_set(error, PS_ERROR_INVALID, "glTF: %s", what);
}

/* --- buffers
 * ----------------------------------------------------------------------------------- */

static int base64_digit(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c ? strchr(digits, c) : NULL;
    return found ? (int)(found - digits) : -1;
}

/* Up to its first character that is no digit, as a "=" at the end. */
static ps_result decode_base64(struct gltf *gltf, const char *text, size_t length,
                               struct gltf_bytes *bytes, struct error *error)
{
    unsigned char *target = arena_allocate(&gltf->arena, length / 4 * 3 + 3);
    uint32_t bits = 0;
    int held = 0;
    if (!target)
        return error_memory(error, length, "a buffer of a mesh file");
    *bytes = (struct gltf_bytes){target, 0};
    for (size_t i = 0; i < length && base64_digit(text[i]) >= 0; i++) {
        bits = bits << 6 | (uint32_t)base64_digit(text[i]);
        held += 6;
        if (held >= 8) {
            held -= 8;
            target[bytes->length++] = (unsigned char)(bits >> held);
        }
    }
    return PS_OK;
}

static ps_result read_data_uri(struct gltf *gltf, const struct json_text *uri,
                               struct gltf_bytes *bytes, struct error *error)
{
    static const char mark[] = ";base64,";
    const size_t length = sizeof mark - 1;
    for (size_t i = 5; i + length <= uri->length; i++)
        if (memcmp(uri->start + i, mark, length) == 0)
            return decode_base64(gltf, uri->start + i + length, uri->length - i - length, bytes,
                                 error);
    return gltf_refuse(error, "a buffer's data are not in base64");
}

static ps_result read_buffer_file(struct gltf *gltf, const struct json_text *uri,
                                  struct gltf_bytes *bytes, struct error *error)
{
    char path[LONGEST_PATH];
    const char *own = gltf->file->path;
    struct mesh_file *file;
    int length = snprintf(path, sizeof path, "%.*s%.*s", (int)(path_name(own) - own), own,
                          uri->length < LONGEST_PATH ? (int)uri->length : LONGEST_PATH, uri->start);
    if (length < 0 || (size_t)length >= sizeof path || memchr(uri->start, '\\', uri->length))
        return gltf_refuse(error, "a buffer's name is too long, or escaped");
    ps_result result = mesh_files_read(gltf->files, path, &file, error);
    if (result != PS_OK) {
        mesh_decode_percent(path);
        result = mesh_files_read(gltf->files, path, &file, error);
    }
    if (result == PS_OK && file == gltf->file) /* whose bytes are written anew */
        return gltf_refuse(error, "a buffer names this file itself");
    if (result == PS_OK)
        *bytes = (struct gltf_bytes){(const unsigned char *)file->bytes, file->length};
    return result;
}

static ps_result read_buffer(struct gltf *gltf, size_t index, struct gltf_bytes *bytes,
                             struct error *error)
{
    const struct json *uri =
        json_member(json_element(json_member(gltf->root, "buffers"), index), "uri");
    if (!uri && index == 0 && gltf_binary_chunk(gltf, bytes))
        return PS_OK;
    if (!uri || uri->kind != JSON_STRING)
        return gltf_refuse(error, "a buffer that is not there is used");
    if (gltf->buffers[index].bytes) {
        *bytes = gltf->buffers[index];
        return PS_OK;
    }
    bool is_data = uri->text.length > 5 && memcmp(uri->text.start, "data:", 5) == 0;
    ps_result result = is_data ? read_data_uri(gltf, &uri->text, bytes, error)
                               : read_buffer_file(gltf, &uri->text, bytes, error);
    gltf->buffers[index] = result == PS_OK ? *bytes : (struct gltf_bytes){0};
    return result;
}

/* The part of a buffer that a view, or its extension, names. */
static ps_result read_part(struct gltf *gltf, const struct json *part, struct gltf_bytes *bytes,
                           struct error *error)
{
    size_t buffer, offset, length;
    if (!json_size(part, "buffer", SIZE_MAX, &buffer) || buffer >= gltf->buffer_count ||
        !json_size(part, "byteOffset", 0, &offset) || !json_size(part, "byteLength", 0, &length))
        return gltf_refuse(error, "a view of a buffer is none");
    ps_result result = read_buffer(gltf, buffer, bytes, error);
    if (result != PS_OK)
        return result;
    if (offset > bytes->length || length > bytes->length - offset)
        return gltf_refuse(error, "a buffer is cut short");
    bytes->bytes += offset;
    bytes->length = length;
    return PS_OK;
}

/* --- room
 * ---------------------------------------------------------------------------------------- */

ps_result gltf_take_room(struct gltf *gltf, size_t bytes, void **room, struct error *error)
{
    size_t held = 0;
    for (const struct mesh_file *file = gltf->files->read; file; file = file->next)
        held += file->made ? 0 : file->length;
    if (bytes > held * GLTF_EXPANSION || gltf->unpacked > held * GLTF_EXPANSION - bytes)
        return error_set(error, PS_ERROR_INVALID,
                         "glTF: unpacked it would be more than %d times as large as its files",
                         GLTF_EXPANSION);
    gltf->unpacked += bytes;
    *room = arena_allocate(&gltf->arena, bytes);
    return *room ? PS_OK : error_memory(error, bytes, "the numbers of a mesh file");
}

/* --- views
 * --------------------------------------------------------------------------------------- */

static const struct json *view_of(const struct gltf *gltf, size_t index)
{
    return json_element(json_member(gltf->root, "bufferViews"), index);
}

/* Left alone where this build cannot unpack and the file has the bytes beside. */
static const struct json *packing_of(const struct gltf *gltf, const struct json *view)
{
    const struct json *packing =
        json_member(json_member(view, "extensions"), "EXT_meshopt_compression");
    size_t buffer;
    bool has_plain = json_size(view, "buffer", SIZE_MAX, &buffer) &&
                     json_member(json_element(json_member(gltf->root, "buffers"), buffer), "uri");
    return meshopt_is_built() || !has_plain ? packing : NULL;
}

ps_result gltf_unpack_view(struct gltf *gltf, size_t index, struct error *error)
{
    struct gltf_bytes packed = {0}, *unpacked;
    const struct json *view = view_of(gltf, index), *packing = packing_of(gltf, view);
    if (!packing || gltf->views[index].bytes)
        return PS_OK;
    unpacked = &gltf->views[index];
    ps_result result = read_part(gltf, packing, &packed, error);
    return result == PS_OK ? meshopt_unpack(gltf, packing, &packed, unpacked, error) : result;
}

static ps_result read_view(struct gltf *gltf, size_t index, struct gltf_bytes *bytes,
                           struct error *error)
{
    const struct json *view = view_of(gltf, index);
    if (!view)
        return gltf_refuse(error, "an accessor has a view that the file lacks");
    ps_result result = gltf_unpack_view(gltf, index, error);
    if (result != PS_OK)
        return result;
    *bytes = gltf->views[index];
    return bytes->bytes ? PS_OK : read_part(gltf, view, bytes, error);
}

/* --- accessors
 * ----------------------------------------------------------------------------------- */

static size_t component_size(enum gltf_component type)
{
    switch (type) {
    case GLTF_BYTE:
    case GLTF_UNSIGNED_BYTE:
        return 1;
    case GLTF_SHORT:
    case GLTF_UNSIGNED_SHORT:
        return 2;
    case GLTF_UNSIGNED_INT:
    case GLTF_FLOAT:
        return 4;
    }
    return 0;
}

static unsigned component_count(const struct json *type)
{
    static const char *const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    for (unsigned i = 0; i < 4; i++)
        if (type && type->kind == JSON_STRING && json_is(&type->text, names[i]))
            return i + 1;
    return 0;
}

static ps_result read_form(const struct json *source, struct gltf_accessor *accessor,
                           struct error *error)
{
    size_t type;
    const struct json *normalized = json_member(source, "normalized");
    if (!json_size(source, "componentType", 0, &type) || type > GLTF_FLOAT ||
        component_size((enum gltf_component)type) == 0 ||
        !json_size(source, "count", 0, &accessor->count))
        return gltf_refuse(error, "an accessor has no kind of numbers");
    accessor->type = (enum gltf_component)type;
    accessor->components = component_count(json_member(source, "type"));
    accessor->normalized =
        normalized && normalized->kind == JSON_BOOLEAN && json_is(&normalized->text, "true");
    if (json_member(source, "sparse"))
        return gltf_refuse(error, "an accessor of integers or instances is sparse");
    if (accessor->count == 0)
        return gltf_refuse(error, "an accessor has no elements");
    return accessor->components ? PS_OK : gltf_refuse(error, "an accessor is of no known type");
}

ps_result gltf_accessor_open(struct gltf *gltf, size_t index, struct gltf_accessor *accessor,
                             struct error *error)
{
    const struct json *source = json_element(json_member(gltf->root, "accessors"), index);
    struct gltf_bytes bytes = {0};
    size_t view, offset;
    *accessor = (struct gltf_accessor){0};
    ps_result result = read_form(source, accessor, error);
    if (result != PS_OK)
        return result;
    size_t element = accessor->components * component_size(accessor->type);
    if (element == 0 || !json_size(source, "bufferView", SIZE_MAX, &view) ||
        !json_size(source, "byteOffset", 0, &offset) ||
        !json_size(view_of(gltf, view), "byteStride", 0, &accessor->stride))
        return gltf_refuse(error, "an accessor's place is no number");
    if (view == SIZE_MAX) {
        static const unsigned char zeros[4 * sizeof(float)];
        accessor->bytes = zeros;
        accessor->stride = 0;
        return PS_OK;
    }
    result = read_view(gltf, view, &bytes, error);
    if (result != PS_OK)
        return result;
    if (accessor->stride == 0)
        accessor->stride = element;
    if (accessor->stride < element || offset > bytes.length || element > bytes.length - offset ||
        accessor->count - 1 > (bytes.length - offset - element) / accessor->stride)
        return gltf_refuse(error, "an accessor goes beyond its view");
    accessor->bytes = bytes.bytes + offset;
    return PS_OK;
}

uint32_t gltf_little_endian(const void *source, size_t size)
{
    const unsigned char *bytes = source;
    uint32_t value = 0;
    for (size_t i = size; i-- > 0;)
        value = value << 8 | bytes[i];
    return value;
}

float gltf_accessor_value(const struct gltf_accessor *accessor, size_t element, unsigned component)
{
    size_t size = component_size(accessor->type);
    uint32_t bits =
        gltf_little_endian(accessor->bytes + element * accessor->stride + component * size, size);
    double value = bits, largest = size == 1 ? 255 : size == 2 ? 65535 : 4294967295.0;
    if (accessor->type == GLTF_FLOAT) {
        float number;
        memcpy(&number, &bits, sizeof number);
        return number;
    }
    if (accessor->type == GLTF_BYTE || accessor->type == GLTF_SHORT) {
        value = value > largest / 2 ? value - largest - 1 : value;
        largest = (largest - 1) / 2;
    }
    if (!accessor->normalized)
        return (float)value;
    return (float)(value < -largest ? -1 : value / largest);
}
