/* scene_geometry.c: the shapes of a scene: the world's, the lights', the groups'; and instances.
 *
 * Planes without an extent are as large as the rest of the scene asks for, so they are made last.
 */
#include "base/machine.h"
#include "base/text.h"
#include "scene/scene_box.h"
#include "scene/scene_parts.h"

#include <psplat/math.h>
#include <stdlib.h>

static void measure(struct scene *scene)
{
    struct box box = scene_box_of_shapes(scene, 0, scene->world_shape_count);
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct instance *instance = &scene->instances[i];
        const struct group *group = instance->group;
        struct box shapes = scene_box_of_shapes(scene, group->first_shape, group->shape_count);
        box_add_placed(&box, &shapes, &instance->placement);
    }
    scene->radius = 0.0f;
    scene->center = (ps_vec3){0, 0, 0};
    if (box_is_empty(&box))
        return;
    scene->center = box_center(&box);
    scene->radius = 0.5f * ps_length(ps_subtract(box.high, box.low));
}

/* --- shapes
 * -------------------------------------------------------------------------------------- */

/* Brightness of a texture, in rows from the top. */
static float *sample_heights(struct assembly *assembly, size_t texture,
                             struct height_samples *heights)
{
    const struct texture *from = &assembly->scene->textures[texture];
    size_t count = (size_t)from->width * from->height;
    float *samples = assembly_allocate(assembly, count, sizeof *samples);
    for (size_t i = 0; samples && i < count; i++) {
        float rgba[4];
        size_t x = i % from->width, y = i / from->width;
        texture_sample(from, ((float)x + 0.5f) / (float)from->width,
                       1.0f - ((float)y + 0.5f) / (float)from->height, rgba);
        samples[i] = (rgba[0] + rgba[1] + rgba[2]) / 3.0f;
    }
    *heights = (struct height_samples){from->width, from->height, samples};
    return samples;
}

/* Makes the shape of number `slot`. */
static ps_result add_shape(struct assembly *assembly, const struct object_description *object,
                           const struct shape_surroundings *surroundings, size_t slot)
{
    struct scene *scene = assembly->scene;
    struct shape_surroundings around = *surroundings;
    struct height_samples heights;
    float *samples = NULL;
    assembly->where = object->origin;
    around.meshes = assembly->description->meshes;
    if (object->kind == OBJECT_HEIGHT_FIELD) {
        samples = sample_heights(assembly, object->texture, &heights);
        if (!samples)
            return PS_ERROR_MEMORY;
        around.heights = &heights;
    }
    ps_result result = shape_create(object, &around, &scene->shapes[slot], assembly->error);
    free(samples);
    if (result != PS_OK)
        return result;
    if (scene->dropped_triangles == 0 && scene->shapes[slot].dropped > 0)
        assembly->dropped_at = object->origin;
    scene->dropped_triangles += scene->shapes[slot].dropped;
    return PS_OK;
}

/* Whether a plane takes its place from all else. */
static bool asks_for_box(const struct scene_description *description)
{
    for (size_t i = 0; i < description->object_count; i++)
        if (description->objects[i].kind == OBJECT_PLANE &&
            description->objects[i].distance == DISTANCE_BELOW_ALL)
            return true;
    return false;
}

/* The objects of the world that are shapes, numbered in their order: planes that come last or the
 * others. */
static ps_result add_world(struct assembly *assembly, bool last)
{
    const struct scene_description *description = assembly->description;
    const struct scene *scene = assembly->scene;
    const struct box box =
        last && asks_for_box(description) ? scene_box(description, scene) : (struct box)BOX_EMPTY;
    struct shape_surroundings surroundings = {
        .center = scene->center, .radius = scene->radius, .box = &box};
    size_t slot = 0;
    for (size_t i = 0; i < description->object_count; i++) {
        const struct object_description *object = &description->objects[i];
        if (object->kind == OBJECT_INSTANCE)
            continue;
        ps_result result = object_comes_last(object) == last
                               ? add_shape(assembly, object, &surroundings, slot)
                               : PS_OK;
        if (result != PS_OK)
            return result;
        slot++;
    }
    return PS_OK;
}

static float lamp_area(const struct shape *shape)
{
    double twice = 0;
    if (shape->kind == SHAPE_SPHERE)
        return 4.0f * PS_PI * shape->radius * shape->radius;
    for (size_t i = 0; i < shape->triangle_count; i++) {
        const uint32_t *corner = shape->triangles[i];
        ps_vec3 a = ps_subtract(shape->vertices[corner[1]], shape->vertices[corner[0]]);
        ps_vec3 b = ps_subtract(shape->vertices[corner[2]], shape->vertices[corner[0]]);
        twice += (double)ps_length(ps_cross(a, b));
    }
    return (float)(0.5 * twice);
}

static ps_result add_lamp(struct assembly *assembly, const struct light_description *light,
                          size_t material, size_t slot)
{
    struct scene *scene = assembly->scene;
    struct shape_surroundings surroundings = {.radius = 0};
    struct object_description object;
    assembly->where = light->origin;
    if (!lamp_describe(light, &object))
        return error_memory(assembly->error, 1 << 12, "a light");
    object.material = material;
    ps_result result = add_shape(assembly, &object, &surroundings, slot);
    object_description_release(&object);
    if (result != PS_OK)
        return result;
    float area = lamp_area(&scene->shapes[slot]);
    material_create_lamp(light_surface_radiance(light, (double)area), light->both_sides,
                         &scene->materials[material]);
    return PS_OK;
}

/* Lights come after the objects, as their materials come after the others. */
static ps_result add_lamps(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    size_t material = description->material_count;
    size_t lights = assembly->scene->material_count - material;
    size_t slot = assembly->scene->world_shape_count - lights;
    for (size_t i = 0; i < description->light_count; i++) {
        if (!light_is_lamp(&description->lights[i]))
            continue;
        ps_result result = add_lamp(assembly, &description->lights[i], material++, slot++);
        if (result != PS_OK)
            return result;
    }
    return PS_OK;
}

/* --- groups and instances ------------------------------------------------------------------- */

static ps_result add_groups(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    struct shape_surroundings surroundings = {.radius = 0};
    size_t slot = scene->world_shape_count;
    for (size_t i = 0; i < description->group_count; i++) {
        const struct group_description *group = &description->groups[i];
        scene->groups[i] = (struct group){slot, group->object_count};
        for (size_t k = 0; k < group->object_count; k++) {
            ps_result result = add_shape(assembly, &group->objects[k], &surroundings, slot++);
            if (result != PS_OK)
                return result;
        }
    }
    scene->group_count = description->group_count;
    return PS_OK;
}

static void add_instances(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    for (size_t i = 0; i < description->object_count; i++) {
        const struct object_description *object = &description->objects[i];
        if (object->kind != OBJECT_INSTANCE)
            continue;
        scene->instances[scene->instance_count++] = (struct instance){
            .group = &scene->groups[object->group],
            .placement = object->placement,
            .front = affine_determinant(&object->placement) < 0.0f ? -1.0f : 1.0f,
            .material = object->material == NO_INDEX ? NO_MATERIAL : (uint32_t)object->material,
            .hidden = object->hidden,
            .front_only = object->front_only,
        };
    }
}

/* Objects are numbered: the world's shapes, then each instance's. */
static void number_objects(struct scene *scene)
{
    scene->object_count = (uint32_t)scene->world_shape_count;
    for (size_t i = 0; i < scene->instance_count; i++) {
        scene->instances[i].first_object = scene->object_count;
        scene->object_count += (uint32_t)scene->instances[i].group->shape_count;
    }
}

/* --- memory
 * -------------------------------------------------------------------------------------- */

/* The ray tracer's tree while it is built, for each triangle of a large mesh; 64 of it stay. */
#define TREE_BYTES 80.0

static double mesh_bytes(const struct mesh_description *mesh)
{
    return (double)mesh->vertex_count * (double)VERTEX_BYTES(mesh) +
           (double)mesh->triangle_count * (sizeof *mesh->triangles + TREE_BYTES);
}

/* Of a list of objects: what their meshes will take, and how many triangles they have; `most`: the
 * largest one. */
struct mesh_sums {
    double bytes, triangles;
    const struct object_description *most;
    size_t most_triangles;
};

static void add_meshes(const struct scene_description *description,
                       const struct object_description *objects, size_t count,
                       struct mesh_sums *sums)
{
    for (size_t i = 0; i < count; i++) {
        if (objects[i].kind != OBJECT_MESH)
            continue;
        const struct mesh_description *mesh = &description->meshes[objects[i].mesh];
        sums->bytes += mesh_bytes(mesh);
        sums->triangles += (double)mesh->triangle_count;
        if (mesh->triangle_count > sums->most_triangles) {
            sums->most_triangles = mesh->triangle_count;
            sums->most = &objects[i];
        }
    }
}

/* Whether the meshes, which the description still has, fit in a second time, with the ray tracer's
 * tree: a system that lends more memory than it has would end the process later. */
static ps_result check_memory(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct mesh_sums sums = {.bytes = 0.0};
    add_meshes(description, description->objects, description->object_count, &sums);
    for (size_t i = 0; i < description->group_count; i++)
        add_meshes(description, description->groups[i].objects, description->groups[i].object_count,
                   &sums);
    double wanted = sums.bytes + machine_memory_of_process();
    double there = machine_memory_within(description->memory_limit);
    if (!sums.most || wanted <= there)
        return PS_OK;
    char taken[TEXT_SIZE_LENGTH], limit[TEXT_SIZE_LENGTH];
    assembly->where = sums.most->origin;
    return error_set(assembly->error, PS_ERROR_MEMORY,
                     "the scene's %.0f triangles take %s of memory while it is made, and %s %s",
                     sums.triangles, text_of_size(wanted, taken),
                     there == description->memory_limit ? "--memory-limit is" : "this machine has",
                     text_of_size(there, limit));
}

/* Room for all shapes, zeroed: such a shape can be released. */
static ps_result reserve(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    scene->world_shape_count = scene->material_count - description->material_count;
    for (size_t i = 0; i < description->object_count; i++)
        scene->world_shape_count += description->objects[i].kind != OBJECT_INSTANCE;
    size_t shapes = scene->world_shape_count;
    for (size_t i = 0; i < description->group_count; i++)
        shapes += description->groups[i].object_count;
    scene->shapes = assembly_allocate(assembly, shapes, sizeof *scene->shapes);
    scene->groups = assembly_allocate(assembly, description->group_count, sizeof *scene->groups);
    scene->instances =
        assembly_allocate(assembly, description->object_count, sizeof *scene->instances);
    if (!scene->shapes || !scene->groups || !scene->instances)
        return PS_ERROR_MEMORY;
    scene->shape_count = shapes;
    return PS_OK;
}

ps_result assembly_add_geometry(struct assembly *assembly)
{
    ps_result result = check_memory(assembly);
    if (result == PS_OK)
        result = reserve(assembly);
    if (result == PS_OK)
        result = add_groups(assembly);
    if (result == PS_OK)
        result = add_world(assembly, false);
    if (result == PS_OK)
        result = add_lamps(assembly);
    if (result != PS_OK)
        return result;
    add_instances(assembly);
    number_objects(assembly->scene);
    measure(assembly->scene);
    result = add_world(assembly, true);
    measure(assembly->scene);
    return result;
}
