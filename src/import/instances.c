/* instances.c: translations, rotations and scales of instances, each an accessor, each optional. */
#include "import/instances.h"

#include <stdint.h>

struct accessors {
    struct gltf_accessor translation, rotation, scale; /* of no elements: not there */
    size_t count;
};

static ps_result complain(struct error *error, const char *what)
{
    return error_set(error, PS_ERROR_INVALID, "glTF: EXT_mesh_gpu_instancing: %s", what);
}

static ps_result open_one(struct gltf *gltf, const struct json *attributes, const char *name,
                          unsigned components, struct accessors *accessors,
                          struct gltf_accessor *accessor, struct error *error)
{
    size_t index;
    if (!json_member(attributes, name))
        return PS_OK;
    if (!json_size(attributes, name, SIZE_MAX, &index))
        return complain(error, "an attribute is no accessor");
    ps_result result = gltf_accessor_open(gltf, index, accessor, error);
    if (result != PS_OK)
        return result;
    if (accessor->components != components ||
        (accessors->count != SIZE_MAX && accessor->count != accessors->count))
        return complain(error, "its attributes do not fit each other");
    accessors->count = accessor->count;
    return PS_OK;
}

static ps_result open_all(struct gltf *gltf, const struct json *attributes,
                          struct accessors *accessors, struct error *error)
{
    *accessors = (struct accessors){.count = SIZE_MAX}; /* none yet */
    ps_result result =
        open_one(gltf, attributes, "TRANSLATION", 3, accessors, &accessors->translation, error);
    if (result == PS_OK)
        result = open_one(gltf, attributes, "ROTATION", 4, accessors, &accessors->rotation, error);
    if (result == PS_OK)
        result = open_one(gltf, attributes, "SCALE", 3, accessors, &accessors->scale, error);
    return result;
}

static void read_values(const struct gltf_accessor *accessor, size_t element, unsigned count,
                        float *values)
{
    for (unsigned i = 0; accessor->bytes && i < count; i++)
        values[i] = gltf_accessor_value(accessor, element, i);
}

static ps_vec3 scaled(float x, float y, float z, float factor)
{
    return (ps_vec3){x * factor, y * factor, z * factor};
}

/* Scale, then rotation, then translation. */
static struct affine read_placement(const struct accessors *accessors, size_t element)
{
    float t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    read_values(&accessors->translation, element, 3, t);
    read_values(&accessors->rotation, element, 4, q);
    read_values(&accessors->scale, element, 3, s);
    float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4 && length > 0; i++)
        q[i] /= length; /* those of integers are rounded */
    float x = q[0], y = q[1], z = q[2], w = q[3];
    return (struct affine){
        scaled(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), s[0]),
        scaled(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), s[1]),
        scaled(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), s[2]),
        {t[0], t[1], t[2]},
    };
}

ps_result mesh_read_instances(struct gltf *gltf, const struct json *node, size_t meshes,
                              struct mesh_instances *instances, struct error *error)
{
    const struct json *extension =
        json_member(json_member(node, "extensions"), "EXT_mesh_gpu_instancing");
    struct accessors accessors;
    *instances = (struct mesh_instances){0};
    if (!extension)
        return PS_OK;
    ps_result result = open_all(gltf, json_member(extension, "attributes"), &accessors, error);
    instances->present = accessors.count != SIZE_MAX;
    if (result != PS_OK || !instances->present)
        return result;
    if (accessors.count > (MESH_OBJECTS - gltf->placed) / meshes)
        return complain(error, "instances make more than 1000000 objects");
    gltf->placed += accessors.count * meshes;
    size_t bytes = accessors.count * sizeof *instances->placements;
    instances->placements = arena_allocate(&gltf->arena, bytes);
    if (!instances->placements)
        return error_memory(error, bytes, "the instances of a mesh");
    instances->count = accessors.count;
    for (size_t i = 0; i < accessors.count; i++)
        instances->placements[i] = read_placement(&accessors, i);
    return PS_OK;
}
