/* gltf_unpack.c: the document as assimp can read it.
 *
 * assimp copies integers into floats bit by bit, and does not know EXT_meshopt_compression. So
 * coordinates that are integers, and views that are packed, are unpacked into a buffer of their
 * own, a file that exists for assimp alone; the JSON names that in place of what the file has. So
 * are accessors without a view, which are zeros (3.6.2.1) and which assimp leaves out. Pictures
 * that only an extension of a texture names become its source: a kind that is not read is told like
 * any other.
 */
#include "import/gltf_data.h"

#include "base/path.h"
#include "image/raster.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_PATH 4096

struct piece {
    struct piece *next;
    const unsigned char *bytes;
    size_t length, offset;
};

struct unpacking {
    struct gltf *gltf;
    struct error *error;
    struct piece *first, **link;
    size_t length;              /* of the buffer so far, a multiple of 4 */
    size_t *accessors;          /* for each, the index + 1 of the one in floats, or 0 */
    size_t new_views;           /* and as many new accessors */
    FILE *views, *accessors_to; /* JSON to append */
};

static ps_result no_memory(const struct unpacking *unpacking)
{
    return error_memory(unpacking->error, sizeof(struct piece), "the numbers of a mesh file");
}

static struct piece *add_piece(struct unpacking *unpacking, const void *bytes, size_t length)
{
    struct piece *piece = arena_allocate(&unpacking->gltf->arena, sizeof *piece);
    if (!piece)
        return NULL;
    *piece = (struct piece){NULL, bytes, length, unpacking->length};
    *unpacking->link = piece;
    unpacking->link = &piece->next;
    unpacking->length += (length + 3) / 4 * 4;
    return piece;
}

static struct json *array_of(const struct gltf *gltf, const char *name)
{
    struct json *array = json_member(gltf->root, name);
    return array && array->kind == JSON_ARRAY ? array : NULL;
}

/* --- views that are packed
 * --------------------------------------------------------------------- */

/* Of an accessor, or a part of one that is sparse. */
static ps_result unpack_view_of(struct unpacking *unpacking, const struct json *user)
{
    struct gltf *gltf = unpacking->gltf;
    char text[256], stride_text[48] = "";
    size_t index, stride;
    if (!json_size(user, "bufferView", SIZE_MAX, &index) || index >= gltf->view_count)
        return PS_OK;
    struct json *view = json_element(array_of(gltf, "bufferViews"), index);
    ps_result result = gltf_unpack_view(gltf, index, unpacking->error);
    const struct gltf_bytes *bytes = &gltf->views[index];
    if (result != PS_OK || !bytes->bytes || view->replacement)
        return result;
    const struct piece *piece = add_piece(unpacking, bytes->bytes, bytes->length);
    if (!piece)
        return no_memory(unpacking);
    if (json_size(view, "byteStride", 0, &stride) && stride > 0)
        snprintf(stride_text, sizeof stride_text, ",\"byteStride\":%zu", stride);
    int length =
        snprintf(text, sizeof text, "{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu%s}",
                 gltf->buffer_count, piece->offset, bytes->length, stride_text);
    view->replacement = arena_copy(&gltf->arena, text, (size_t)length);
    return view->replacement ? PS_OK : no_memory(unpacking);
}

static ps_result unpack_views_of(struct unpacking *unpacking, size_t index)
{
    const struct json *accessor = json_element(array_of(unpacking->gltf, "accessors"), index);
    const struct json *sparse = json_member(accessor, "sparse");
    ps_result result = unpack_view_of(unpacking, accessor);
    if (result == PS_OK)
        result = unpack_view_of(unpacking, json_member(sparse, "indices"));
    if (result == PS_OK)
        result = unpack_view_of(unpacking, json_member(sparse, "values"));
    return result;
}

/* --- integers
 * ---------------------------------------------------------------------------------- */

static bool is_integer(const struct gltf *gltf, size_t accessor)
{
    size_t type;
    const struct json *source = json_element(array_of(gltf, "accessors"), accessor);
    return source && json_size(source, "componentType", GLTF_FLOAT, &type) && type != GLTF_FLOAT;
}

static bool is_zeros(const struct gltf *gltf, size_t accessor)
{
    const struct json *source = json_element(array_of(gltf, "accessors"), accessor);
    return source && !json_member(source, "bufferView") && !json_member(source, "sparse");
}

static ps_result append_floats(struct unpacking *unpacking, const struct gltf_accessor *source,
                               size_t *index)
{
    struct gltf *gltf = unpacking->gltf;
    size_t count = source->count * source->components;
    void *room;
    ps_result result = gltf_take_room(gltf, count * sizeof(float), &room, unpacking->error);
    if (result != PS_OK)
        return result;
    float *floats = room;
    const struct piece *piece = add_piece(unpacking, floats, count * sizeof *floats);
    if (!piece)
        return no_memory(unpacking);
    for (size_t i = 0; i < count; i++)
        floats[i] =
            gltf_accessor_value(source, i / source->components, (unsigned)(i % source->components));
    const char *comma = unpacking->new_views > 0 ? "," : "";
    fprintf(unpacking->views, "%s{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu}", comma,
            gltf->buffer_count, piece->offset, piece->length);
    fprintf(unpacking->accessors_to,
            "%s{\"bufferView\":%zu,\"componentType\":5126,\"count\":%zu,\"type\":\"VEC%u\"}", comma,
            gltf->view_count + unpacking->new_views, source->count, source->components);
    *index = gltf->accessor_count + unpacking->new_views++;
    return PS_OK;
}

static ps_result convert_attribute(struct unpacking *unpacking, struct json *attribute,
                                   size_t accessor, unsigned components)
{
    struct gltf *gltf = unpacking->gltf;
    size_t *converted = &unpacking->accessors[accessor];
    struct gltf_accessor source;
    char text[32];
    if (*converted == 0) {
        ps_result result = gltf_accessor_open(gltf, accessor, &source, unpacking->error);
        if (result != PS_OK)
            return result;
        if (components > 0 ? source.components != components : source.components < 3)
            return error_set(unpacking->error, PS_ERROR_INVALID,
                             "glTF: an accessor is of the wrong type for what it stands for");
        result = append_floats(unpacking, &source, converted);
        if (result != PS_OK)
            return result;
        ++*converted;
    }
    int length = snprintf(text, sizeof text, "%zu", *converted - 1);
    attribute->replacement = arena_copy(&gltf->arena, text, (size_t)length);
    return attribute->replacement ? PS_OK : no_memory(unpacking);
}

/* --- what a mesh uses
 * ---------------------------------------------------------------------------- */

static const struct attribute {
    const char *name;
    unsigned components; /* 0: integers may stay */
} attributes[] = {
    {"POSITION", 3}, {"NORMAL", 3}, {"TEXCOORD_0", 2}, {"TEXCOORD_1", 2}, {"COLOR_0", 0}};

#define ATTRIBUTE_COUNT (sizeof attributes / sizeof *attributes)

/* Here nothing unpacks it, and assimp takes its integers for floats. */
static ps_result leave_out_draco(const struct unpacking *unpacking, const struct json *primitive,
                                 const char *name)
{
    const struct json *draco =
        json_member(json_member(primitive, "extensions"), "KHR_draco_mesh_compression");
    struct json *compressed = json_member(json_member(draco, "attributes"), name);
    if (strcmp(name, "POSITION") == 0)
        return error_set(unpacking->error, PS_ERROR_INVALID,
                         "glTF: positions that are integers compressed by Draco cannot be read");
    json_member(json_member(primitive, "attributes"), name)->hidden = true;
    if (compressed)
        compressed->hidden = true;
    unpacking->gltf->draco_integers = true;
    return PS_OK;
}

static ps_result unpack_attribute(struct unpacking *unpacking, const struct json *primitive,
                                  const struct attribute *attribute)
{
    struct json *reference = json_member(json_member(primitive, "attributes"), attribute->name);
    size_t accessor;
    if (!reference ||
        !json_size(json_member(primitive, "attributes"), attribute->name, SIZE_MAX, &accessor) ||
        accessor >= unpacking->gltf->accessor_count)
        return PS_OK;
    bool zeros = is_zeros(unpacking->gltf, accessor) && !gltf_is_draco(primitive);
    if (!zeros && (attribute->components == 0 || !is_integer(unpacking->gltf, accessor)))
        return unpack_views_of(unpacking, accessor);
    if (gltf_is_draco(primitive))
        return leave_out_draco(unpacking, primitive, attribute->name);
    return convert_attribute(unpacking, reference, accessor, attribute->components);
}

static ps_result unpack_primitive(struct unpacking *unpacking, const struct json *primitive)
{
    ps_result result = PS_OK;
    size_t indices;
    for (size_t i = 0; result == PS_OK && i < ATTRIBUTE_COUNT; i++)
        result = unpack_attribute(unpacking, primitive, &attributes[i]);
    if (result == PS_OK && json_size(primitive, "indices", SIZE_MAX, &indices))
        result = unpack_views_of(unpacking, indices);
    return result;
}

/* --- textures
 * ------------------------------------------------------------------------------------ */

/* What psplat reads comes first, then the file's own choice, then what it does not read. */
static const struct json *choose_picture(const struct json *texture)
{
    static const char *const names[] = {"EXT_texture_webp", "KHR_texture_basisu"};
    const struct json *extensions = json_member(texture, "extensions");
    const struct json *webp = json_member(extensions, names[0]);
    if (webp && strstr(raster_kinds, "WebP"))
        return webp;
    if (json_member(texture, "source"))
        return NULL;
    return webp ? webp : json_member(extensions, names[1]);
}

static ps_result replace_texture(struct unpacking *unpacking, struct json *texture)
{
    char text[96], sampler_text[48] = "";
    size_t source, sampler;
    const struct json *chosen = choose_picture(texture);
    if (!chosen || !json_size(chosen, "source", SIZE_MAX, &source) || source == SIZE_MAX)
        return PS_OK;
    if (json_size(texture, "sampler", SIZE_MAX, &sampler) && sampler != SIZE_MAX)
        snprintf(sampler_text, sizeof sampler_text, ",\"sampler\":%zu", sampler);
    int length = snprintf(text, sizeof text, "{\"source\":%zu%s}", source, sampler_text);
    texture->replacement = arena_copy(&unpacking->gltf->arena, text, (size_t)length);
    return texture->replacement ? PS_OK : no_memory(unpacking);
}

/* --- the document
 * -------------------------------------------------------------------------------- */

/* A file beside the mesh that is not there: one that is would be hidden. */
static bool choose_path(const struct gltf *gltf, char path[LONGEST_PATH])
{
    const char *own = gltf->file->path;
    for (unsigned i = 0;; i++) {
        int length = snprintf(path, LONGEST_PATH, "%.*spsplat-unpacked-%u.bin",
                              (int)(path_name(own) - own), own, i);
        if (length < 0 || length >= LONGEST_PATH)
            return false;
        if (!mesh_files_exist(gltf->files, path))
            return true;
    }
}

static ps_result store_buffer(const struct unpacking *unpacking, const char *path)
{
    struct gltf *gltf = unpacking->gltf;
    char *bytes = calloc(unpacking->length + 1, 1);
    if (!bytes)
        return no_memory(unpacking);
    for (const struct piece *piece = unpacking->first; piece; piece = piece->next)
        if (piece->length > 0)
            memcpy(bytes + piece->offset, piece->bytes, piece->length);
    return mesh_files_add(gltf->files, path, bytes, unpacking->length, unpacking->error);
}

static ps_result append(struct unpacking *unpacking, const char *name, const char *text,
                        size_t length)
{
    struct json *array = array_of(unpacking->gltf, name);
    if (length == 0 || !array)
        return PS_OK;
    array->appended = arena_copy(&unpacking->gltf->arena, text, length);
    return array->appended ? PS_OK : no_memory(unpacking);
}

static ps_result append_buffer(struct unpacking *unpacking)
{
    char path[LONGEST_PATH], text[128];
    if (!unpacking->first)
        return PS_OK;
    if (!choose_path(unpacking->gltf, path))
        return error_set(unpacking->error, PS_ERROR_INVALID, "the file's path is too long");
    int length = snprintf(text, sizeof text, "{\"uri\":\"%s\",\"byteLength\":%zu}", path_name(path),
                          unpacking->length);
    ps_result result = append(unpacking, "buffers", text, (size_t)length);
    return result == PS_OK ? store_buffer(unpacking, path) : result;
}

static ps_result unpack_all(struct unpacking *unpacking)
{
    struct gltf *gltf = unpacking->gltf;
    struct json *textures = array_of(gltf, "textures");
    ps_result result = PS_OK;
    for (size_t i = 0; result == PS_OK && i < gltf->primitive_count; i++)
        result = unpack_primitive(unpacking, gltf->primitives[i]);
    for (size_t i = 0; result == PS_OK && textures && i < textures->count; i++)
        result = replace_texture(unpacking, json_element(textures, i));
    return result == PS_OK ? append_buffer(unpacking) : result;
}

ps_result gltf_unpack(struct gltf *gltf, struct error *error)
{
    struct unpacking unpacking = {.gltf = gltf, .error = error};
    char *views = NULL, *accessors = NULL;
    size_t views_length = 0, accessors_length = 0;
    ps_result result = PS_ERROR_MEMORY;
    unpacking.link = &unpacking.first;
    unpacking.accessors = arena_allocate(&gltf->arena, (gltf->accessor_count + 1) * sizeof(size_t));
    unpacking.views = open_memstream(&views, &views_length);
    unpacking.accessors_to = open_memstream(&accessors, &accessors_length);
    if (unpacking.accessors && unpacking.views && unpacking.accessors_to)
        result = unpack_all(&unpacking);
    else
        no_memory(&unpacking);
    bool whole = (!unpacking.views || fclose(unpacking.views) == 0);
    whole &= (!unpacking.accessors_to || fclose(unpacking.accessors_to) == 0);
    if (result == PS_OK && !whole)
        result = no_memory(&unpacking);
    if (result == PS_OK)
        result = append(&unpacking, "bufferViews", views, views_length);
    if (result == PS_OK)
        result = append(&unpacking, "accessors", accessors, accessors_length);
    free(views);
    free(accessors);
    return result;
}
