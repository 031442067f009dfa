/* gltf_check.c: the rules of a glTF 2 document that assimp relies on and does not check. */
#include "import/gltf.h"

#include <string.h>

#define LONGEST_NAME 500

static ps_result complain(struct error *error, const char *what)
{
    return error_set(error, PS_ERROR_INVALID, "glTF: %s", what);
}

static const char *const known_extensions[] = {
    "KHR_lights_punctual",  "KHR_materials_emissive_strength",
    "KHR_materials_ior",    "KHR_materials_transmission",
    "KHR_materials_volume", "KHR_texture_transform",
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
