/* mesh_gltf_check.c: the rules of glTF 2 that assimp relies on and does not check. */
#include "parser/mesh_gltf.h"

#include <string.h>

#define LONGEST_NAME 500

static ps_result complain(struct error *error, const char *what)
{
    return error_set(error, PS_ERROR_INVALID, "glTF: %s", what);
}

/* --- the document ------------------------------------------------------------------------------- */

static const char *const known_extensions[] = {
    "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_materials_volume",       "KHR_texture_transform",
};

static bool is_known_extension(const struct json *name)
{
    if (name->kind != JSON_STRING)
        return false;
    for (size_t i = 0; i < sizeof known_extensions / sizeof known_extensions[0]; i++)
        if (json_is(&name->text, known_extensions[i]))
            return true;
    return false;
}

static ps_result check_required_extensions(const struct gltf *gltf, struct error *error)
{
    const struct json *required = json_member(gltf->root, "extensionsRequired");
    for (size_t i = 0; required && i < required->count; i++) {
        const struct json *name = json_element(required, i);
        if (!name)
            return complain(error, "extensionsRequired is no array");
        if (!is_known_extension(name))
            return error_set(error, PS_ERROR_INVALID,
                             "glTF: the file requires the extension %.*s, which psplat lacks",
                             name->text.length < 100 ? (int)name->text.length : 100,
                             name->text.start ? name->text.start : "");
    }
    return PS_OK;
}

static bool is_number_pair(const struct json *array)
{
    const struct json *x = json_element(array, 0), *y = json_element(array, 1);
    return x && y && x->kind == JSON_NUMBER && y->kind == JSON_NUMBER;
}

static bool is_texture_transform(const struct json *value)
{
    const struct json *offset = json_member(value, "offset"), *scale = json_member(value, "scale");
    const struct json *rotation = json_member(value, "rotation");
    return value->kind == JSON_OBJECT && (!offset || is_number_pair(offset)) &&
           (!scale || is_number_pair(scale)) && (!rotation || rotation->kind == JSON_NUMBER);
}

/* Wherever they are; depth is bounded by JSON_DEPTH. */
static ps_result check_texture_transforms(const struct json *value, struct error *error)
{
    ps_result result = PS_OK;
    for (const struct json *item = value->items; result == PS_OK && item; item = item->next) {
        if (value->kind == JSON_OBJECT && json_is(&item->key, "KHR_texture_transform") &&
            !is_texture_transform(item))
            return complain(error, "KHR_texture_transform with other than pairs of numbers");
        result = check_texture_transforms(item, error);
    }
    return result;
}

/* assimp looks for the slash in a type without minding its absence. */
static ps_result check_images(const struct gltf *gltf, struct error *error)
{
    const struct json *images = json_member(gltf->root, "images");
    for (size_t i = 0; images && i < images->count; i++) {
        const struct json *image = json_element(images, i);
        const struct json *type = json_member(image, "mimeType"), *uri = json_member(image, "uri");
        if (type &&
            (type->kind != JSON_STRING || !memchr(type->text.start, '/', type->text.length)))
            return complain(error, "an image has a media type without a slash");
        if (uri && uri->kind == JSON_STRING && uri->text.length >= 5 &&
            memcmp(uri->text.start, "data:", 5) == 0 &&
            !memchr(uri->text.start, '/', uri->text.length < 40 ? uri->text.length : 40))
            return complain(error, "an image has a data URI without a media type");
    }
    return PS_OK;
}

static ps_result check_names(const struct gltf *gltf, struct error *error)
{
    static const char *const lists[] = {"meshes", "nodes", "materials", "images", "textures"};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        const struct json *list = json_member(gltf->root, lists[i]);
        if (list && list->kind != JSON_ARRAY)
            return error_set(error, PS_ERROR_INVALID, "glTF: \"%s\" is no array", lists[i]);
        for (size_t j = 0; list && j < list->count; j++) {
            const struct json *name = json_member(json_element(list, j), "name");
            if (name && (name->kind != JSON_STRING || name->text.length > LONGEST_NAME))
                return error_set(error, PS_ERROR_INVALID,
                                 "glTF: a name in \"%s\" is no string of up to %d bytes", lists[i],
                                 LONGEST_NAME);
        }
    }
    return PS_OK;
}

ps_result gltf_check_document(const struct gltf *gltf, struct error *error)
{
    const struct json *version = json_member(json_member(gltf->root, "asset"), "version");
    if (!version || version->kind != JSON_STRING || version->text.length < 2 ||
        memcmp(version->text.start, "2.", 2) != 0)
        return complain(error, "the file does not say that it is of version 2");
    ps_result result = check_required_extensions(gltf, error);
    if (result == PS_OK)
        result = check_texture_transforms(gltf->root, error);
    if (result == PS_OK)
        result = check_images(gltf, error);
    if (result == PS_OK)
        result = check_names(gltf, error);
    return result;
}

/* --- meshes ------------------------------------------------------------------------------------- */

struct layout {
    size_t component_bytes, components, count;
    bool is_float;
};

static size_t bytes_of_component(size_t type)
{
    switch (type) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

static size_t components_of(const struct json *type)
{
    static const char *const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    for (size_t i = 0; type && type->kind == JSON_STRING && i < 4; i++)
        if (json_is(&type->text, names[i]))
            return i + 1;
    return 0;
}

static ps_result check_view(const struct gltf *gltf, const struct json *accessor,
                            const struct layout *layout, struct error *error)
{
    size_t index, offset, start, length, stride, buffer, buffer_length;
    size_t element = layout->component_bytes * layout->components;
    if (!json_member(accessor, "bufferView") || !json_size(accessor, "bufferView", 0, &index) ||
        !json_size(accessor, "byteOffset", 0, &offset))
        return complain(error, "an accessor without bytes");
    const struct json *view = json_element(json_member(gltf->root, "bufferViews"), index);
    if (!view || !json_size(view, "buffer", SIZE_MAX, &buffer) ||
        !json_size(view, "byteOffset", 0, &start) || !json_size(view, "byteLength", 0, &length) ||
        !json_size(view, "byteStride", element, &stride))
        return complain(error, "an accessor of bytes that the file lacks");
    const struct json *bytes = json_element(json_member(gltf->root, "buffers"), buffer);
    if (!bytes || !json_size(bytes, "byteLength", 0, &buffer_length) || start > buffer_length ||
        length > buffer_length - start)
        return complain(error, "a part of a buffer beyond its end");
    if (stride < element || stride > 65536 || offset > length ||
        (layout->count > 0 && (layout->count - 1 > length / stride ||
                               (layout->count - 1) * stride + element > length - offset)))
        return complain(error, "an accessor beyond the end of its bytes");
    return PS_OK;
}

static ps_result check_accessor(const struct gltf *gltf, const struct json *reference,
                                struct layout *layout, struct error *error)
{
    size_t index, type;
    if (reference->kind != JSON_NUMBER || reference->number < 0 || reference->number > 1e9)
        return complain(error, "an accessor that is no number");
    index = (size_t)reference->number;
    const struct json *accessor = json_element(json_member(gltf->root, "accessors"), index);
    if (!accessor || !json_size(accessor, "componentType", 0, &type) ||
        !json_size(accessor, "count", 0, &layout->count))
        return complain(error, "an accessor that the file lacks");
    if (json_member(accessor, "sparse"))
        return complain(error, "sparse accessors are not supported");
    layout->component_bytes = bytes_of_component(type);
    layout->components = components_of(json_member(accessor, "type"));
    layout->is_float = type == 5126;
    if (layout->component_bytes == 0 || layout->components == 0)
        return complain(error, "an accessor of an unknown type");
    if (layout->count > UINT32_MAX)
        return complain(error, "an accessor of too many elements");
    return check_view(gltf, accessor, layout, error);
}

static ps_result check_attribute(const struct gltf *gltf, const struct json *attributes,
                                 const char *name, size_t components, size_t *count,
                                 struct error *error)
{
    const struct json *reference = json_member(attributes, name);
    struct layout layout;
    if (!reference)
        return PS_OK;
    ps_result result = check_accessor(gltf, reference, &layout, error);
    if (result != PS_OK)
        return result;
    if (!layout.is_float || layout.components != components)
        return error_set(error, PS_ERROR_INVALID, "glTF: %s is not of %zu 32-bit floats", name,
                         components);
    if (*count != SIZE_MAX && *count != layout.count)
        return error_set(error, PS_ERROR_INVALID, "glTF: %s is not of as many as POSITION", name);
    *count = layout.count;
    return PS_OK;
}

/* assimp follows the ends of lines without looking: points do no harm, and neither shows. */
static void count_triangles(struct gltf *gltf, const struct json *primitive, size_t mode,
                            size_t corners)
{
    const struct json *text = json_member(primitive, "mode");
    if (mode >= 1 && mode <= 3)
        gltf->text[text->text.start + text->text.length - 1 - gltf->text] = '0';
    if (mode == 4)
        gltf->triangle_count += corners / 3;
    if (mode >= 5)
        gltf->triangle_count += corners - 2;
}

static ps_result check_primitive(struct gltf *gltf, const struct json *primitive,
                                 struct error *error)
{
    static const size_t least[] = {1, 2, 2, 2, 3, 3, 3};
    const struct json *attributes = json_member(primitive, "attributes");
    const struct json *indices = json_member(primitive, "indices");
    size_t count = SIZE_MAX, mode;
    struct layout layout;
    if (!json_member(attributes, "POSITION"))
        return complain(error, "a mesh without POSITION");
    if (json_member(json_member(primitive, "extensions"), "KHR_draco_mesh_compression"))
        return complain(error, "Draco compression is not supported");
    ps_result result = check_attribute(gltf, attributes, "POSITION", 3, &count, error);
    if (result == PS_OK)
        result = check_attribute(gltf, attributes, "NORMAL", 3, &count, error);
    if (result == PS_OK)
        result = check_attribute(gltf, attributes, "TEXCOORD_0", 2, &count, error);
    if (result == PS_OK && indices)
        result = check_accessor(gltf, indices, &layout, error);
    if (result != PS_OK)
        return result;
    if (indices && (layout.is_float || layout.components != 1))
        return complain(error, "indices of a mesh that are no whole numbers");
    if (!json_size(primitive, "mode", 4, &mode) || mode >= sizeof least / sizeof least[0])
        return complain(error, "a mesh of an unknown mode");
    if ((indices ? layout.count : count) < least[mode] || count == 0)
        return complain(error, "a mesh of too few vertices");
    count_triangles(gltf, primitive, mode, indices ? layout.count : count);
    return PS_OK;
}

ps_result gltf_check_mesh(struct gltf *gltf, size_t index, struct error *error)
{
    const struct json *mesh = json_element(json_member(gltf->root, "meshes"), index);
    const struct json *primitives = json_member(mesh, "primitives");
    if (!primitives || primitives->kind != JSON_ARRAY || primitives->count == 0)
        return complain(error, "a mesh without primitives");
    ps_result result = PS_OK;
    for (size_t i = 0; result == PS_OK && i < primitives->count; i++)
        result = check_primitive(gltf, json_element(primitives, i), error);
    return result;
}

/* --- what assimp need not see --------------------------------------------------------------------- */

/* Only the text changes: the tree still knows the members by their names. */
static void hide(const struct gltf *gltf, const struct json *object, const char *name)
{
    if (!object || object->kind != JSON_OBJECT)
        return;
    for (struct json *item = object->items; item; item = item->next)
        if (json_is(&item->key, name)) {
            gltf->text[item->key.start - gltf->text] = '_';
            item->key.start = name;
        }
}

static void hide_all(const struct gltf *gltf, const struct json *object, const char *const names[])
{
    for (size_t i = 0; names[i]; i++)
        hide(gltf, object, names[i]);
}

static void hide_attributes(const struct gltf *gltf, const struct json *attributes)
{
    if (!attributes || attributes->kind != JSON_OBJECT)
        return;
    for (struct json *item = attributes->items; item; item = item->next)
        if (item->key.length > 0 && !json_is(&item->key, "POSITION") &&
            !json_is(&item->key, "NORMAL") && !json_is(&item->key, "TEXCOORD_0"))
            gltf->text[item->key.start - gltf->text] = '_';
}

static void hide_in_mesh(const struct gltf *gltf, const struct json *mesh)
{
    static const char *const names[] = {"targets", "extensions", "extras", NULL};
    const struct json *primitives = json_member(mesh, "primitives");
    for (size_t i = 0; primitives && i < primitives->count; i++) {
        const struct json *primitive = json_element(primitives, i);
        hide_all(gltf, primitive, names);
        hide_attributes(gltf, json_member(primitive, "attributes"));
    }
}

void gltf_hide_rest(struct gltf *gltf)
{
    static const char *const of_root[] = {"animations", "skins", "cameras", "extensions", NULL};
    static const char *const of_node[] = {"skin", "camera", "extensions", "extras", NULL};
    static const char *const of_mesh[] = {"weights", "extensions", "extras", NULL};
    const struct json *nodes = json_member(gltf->root, "nodes");
    const struct json *meshes = json_member(gltf->root, "meshes");
    for (size_t i = 0; nodes && i < nodes->count; i++)
        hide_all(gltf, json_element(nodes, i), of_node);
    for (size_t i = 0; meshes && i < meshes->count; i++) {
        hide_all(gltf, json_element(meshes, i), of_mesh);
        hide_in_mesh(gltf, json_element(meshes, i));
    }
    hide_all(gltf, gltf->root, of_root);
}
