/* gltf_mesh.c: the rules of glTF 2 for meshes and their bytes. assimp adds offsets that may
 * overflow, and does not look at the stride of the last element. */
#include "import/gltf.h"

static ps_result complain(struct error *error, const char *what)
{
    return error_set(error, PS_ERROR_INVALID, "glTF: %s", what);
}

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
    struct layout layout = {0};
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
    struct layout layout = {0};
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
