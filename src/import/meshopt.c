/* meshopt.c: views that EXT_meshopt_compression packed, through meshoptimizer.
 *
 * Attributes take at least two bits for 16 bytes, triangles a byte for three indices of up to four
 * bytes each, sequences of indices a byte for each: so a view is at most 64 times as large as its
 * packed form, and one that claims more is refused before memory is taken.
 */
#include "import/gltf_data.h"

#ifdef PSPLAT_MESHOPT
#include <meshoptimizer.h>
#endif

static ps_result complain(struct error *error, const char *what)
{
    return error_set(error, PS_ERROR_INVALID, "glTF: EXT_meshopt_compression: %s", what);
}

#ifndef PSPLAT_MESHOPT

bool meshopt_is_built(void)
{
    return false;
}

ps_result meshopt_unpack(struct gltf *gltf, const struct json *extension,
                         const struct gltf_bytes *source, struct gltf_bytes *unpacked,
                         struct error *error)
{
    (void)gltf;
    (void)extension;
    (void)source;
    (void)unpacked;
    return complain(error, "this psplat was built without meshoptimizer, which unpacks it");
}

#else

bool meshopt_is_built(void)
{
    return true;
}

static bool has_text(const struct json *object, const char *name, const char *expected)
{
    const struct json *member = json_member(object, name);
    return member && member->kind == JSON_STRING && json_is(&member->text, expected);
}

struct packing {
    const struct json *extension;
    const unsigned char *source;
    size_t length, count, stride;
};

static int unpack_attributes(const struct packing *packing, void *target)
{
    return packing->stride % 4 == 0 && packing->stride > 0 && packing->stride <= 256
               ? meshopt_decodeVertexBuffer(target, packing->count, packing->stride,
                                            packing->source, packing->length)
               : -1;
}

static int unpack_indices(const struct packing *packing, void *target)
{
    if (packing->stride != 2 && packing->stride != 4)
        return -1;
    if (has_text(packing->extension, "mode", "INDICES"))
        return meshopt_decodeIndexSequence(target, packing->count, packing->stride, packing->source,
                                           packing->length);
    return has_text(packing->extension, "mode", "TRIANGLES") && packing->count % 3 == 0
               ? meshopt_decodeIndexBuffer(target, packing->count, packing->stride, packing->source,
                                           packing->length)
               : -1;
}

/* False: not of a size that the filter is for, or of no known name. */
static bool filter(const struct packing *packing, void *target)
{
    const struct json *extension = packing->extension;
    size_t stride = packing->stride;
    if (!json_member(extension, "filter") || has_text(extension, "filter", "NONE"))
        return true;
    if (has_text(extension, "filter", "OCTAHEDRAL") && (stride == 4 || stride == 8)) {
        meshopt_decodeFilterOct(target, packing->count, stride);
        return true;
    }
    if (has_text(extension, "filter", "QUATERNION") && stride == 8) {
        meshopt_decodeFilterQuat(target, packing->count, stride);
        return true;
    }
    if (has_text(extension, "filter", "EXPONENTIAL") && stride % 4 == 0) {
        meshopt_decodeFilterExp(target, packing->count, stride);
        return true;
    }
    return false;
}

ps_result meshopt_unpack(struct gltf *gltf, const struct json *extension,
                         const struct gltf_bytes *source, struct gltf_bytes *unpacked,
                         struct error *error)
{
    struct packing packing = {
        .extension = extension, .source = source->bytes, .length = source->length};
    if (!json_size(extension, "count", 0, &packing.count) ||
        !json_size(extension, "byteStride", 0, &packing.stride) || packing.count == 0 ||
        packing.stride == 0 || packing.stride > 256 ||
        packing.count > source->length * GLTF_EXPANSION / packing.stride)
        return complain(error, "a view's size cannot be");
    size_t length = packing.count * packing.stride;
    void *target;
    ps_result result = gltf_take_room(gltf, length, &target, error);
    if (result != PS_OK)
        return result;
    bool attributes = has_text(extension, "mode", "ATTRIBUTES");
    int code = attributes ? unpack_attributes(&packing, target) : unpack_indices(&packing, target);
    if (code != 0 || (attributes && !filter(&packing, target)))
        return complain(error, "a view is damaged");
    *unpacked = (struct gltf_bytes){target, length};
    return PS_OK;
}

#endif
