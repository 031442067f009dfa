#include "scene/scene.h"
#include "base/machine.h"

#include "scene/camera_frame.h"
#include "scene/scene_box.h"
#include "scene/scene_parts.h"
#include <stdlib.h>

/* Rays start this many units in the last place of the largest coordinate off their surface: enough
 * for the rounding of a hit point, too little to see. */
#define OFFSET_ULPS 32.0f

/* Outside of these the ray tracer's single precision squares to nothing or infinity. */
#define SMALLEST_RADIUS 1e-6f
#define LARGEST_RADIUS 1e9f

/* Of light_choices, on paths: lower noise there costs more than it gains. */
#define PATH_SHARE 4

void *assembly_allocate(struct assembly *assembly, size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory)
        error_memory(assembly->error, count * size, "the scene");
    return memory;
}

static ps_result check_size(const struct scene *scene, struct error *error)
{
    if (scene->object_count == 0 ||
        (scene->radius > SMALLEST_RADIUS && scene->radius < LARGEST_RADIUS))
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "the scene's radius is %g units; choose units that bring it within %g..%g",
                     (double)scene->radius, (double)SMALLEST_RADIUS, (double)LARGEST_RADIUS);
}

ps_result scene_find_camera(const struct scene_description *description, const struct scene *scene,
                            struct camera_description *camera, struct error *error)
{
    *camera = description->cameras[0];
    if (!camera->finds_location && !camera->finds_look_at)
        return PS_OK;
    struct box box = scene_box_to_frame(description, scene, camera->up);
    return camera_frame(camera, &box, scene->width, scene->height, error);
}

/* After the geometry, as the camera may have to show it. */
static ps_result add_camera(struct assembly *assembly)
{
    struct scene *scene = assembly->scene;
    struct camera_description camera;
    assembly->where = assembly->description->cameras[0].origin;
    ps_result result = scene_find_camera(assembly->description, scene, &camera, assembly->error);
    if (result == PS_OK)
        scene->camera = camera_from_description(&camera, scene->width, scene->height);
    return result;
}

static ps_result assemble(struct assembly *assembly)
{
    struct scene *scene = assembly->scene;
    ps_result result = assembly_add_materials(assembly);
    if (result == PS_OK)
        result = assembly_add_geometry(assembly);
    if (result == PS_OK) {
        assembly->where = (struct origin){0};
        result = check_size(scene, assembly->error);
    }
    if (result == PS_OK)
        result = add_camera(assembly);
    float largest = scene->radius + ps_length(scene->center);
    scene->surface_offset = OFFSET_ULPS * 0x1p-23f * largest;
    if (result == PS_OK)
        result = assembly_add_lights(assembly);
    return result;
}

/* Noise of what a path meets is that of its direction in the first place. */
static uint32_t path_light_choices(uint32_t light_choices)
{
    return light_choices < PATH_SHARE ? 1 : light_choices / PATH_SHARE;
}

ps_result scene_create(const struct scene_description *description, struct scene *scene,
                       struct origin *where, struct error *error)
{
    *scene = (struct scene){
        .width = (size_t)description->image.width,
        .height = (size_t)description->image.height,
        .pixel_filter = (enum pixel_filter)description->image.filter,
        .light_samples = (uint32_t)description->render.light_samples,
        .light_choices = (uint32_t)description->render.light_choices,
        .path_light_choices = path_light_choices((uint32_t)description->render.light_choices),
    };
    struct assembly assembly = {.description = description, .scene = scene, .error = error};
    ps_result result = assemble(&assembly);
    if (where)
        *where = result == PS_OK ? assembly.dropped_at : assembly.where;
    if (result != PS_OK)
        scene_release(scene);
    return result;
}

void scene_release(struct scene *scene)
{
    for (size_t i = 0; i < scene->light_count; i++)
        light_release(&scene->lights[i]);
    for (size_t i = 0; i < scene->shape_count; i++)
        shape_release(&scene->shapes[i]);
    for (size_t i = 0; i < scene->texture_count; i++)
        texture_release(&scene->textures[i]);
    mapped_budget_destroy(scene->texture_memory);
    for (size_t i = 0; i < scene->owned_count; i++)
        free(scene->owned[i]);
    free(scene->owned);
    light_bvh_destroy(scene->light_bvh);
    free(scene->afar);
    free(scene->lights);
    distribution_release(&scene->light_choice);
    free(scene->object_lights);
    free(scene->shapes);
    free(scene->groups);
    free(scene->instances);
    free(scene->materials);
    free(scene->microfacets);
    free(scene->textures);
    *scene = (struct scene){.shapes = NULL};
}

static size_t shape_bytes(const struct shape *shape)
{
    return sizeof *shape + shape->vertex_count * VERTEX_BYTES(shape) +
           shape->triangle_count * sizeof *shape->triangles;
}

size_t scene_bytes(const struct scene *scene)
{
    size_t sum = 0;
    for (size_t i = 0; i < scene->shape_count; i++)
        sum += shape_bytes(&scene->shapes[i]);
    for (size_t i = 0; i < scene->texture_count; i++)
        sum += texture_bytes(&scene->textures[i]);
    sum += light_bvh_bytes(scene->light_bvh);
    return sum;
}

double scene_bytes_to_come(const struct scene *scene)
{
    return scene->texture_memory ? mapped_budget_to_come(scene->texture_memory) : 0.0;
}

bool scene_has_shading_normals(const struct scene *scene)
{
    bool any = false;
    for (size_t i = 0; i < scene->shape_count && !any; i++)
        any = scene->shapes[i].normals != NULL;
    for (size_t i = 0; i < scene->material_count && !any; i++)
        any = scene->materials[i].has_normal_map || scene->materials[i].has_bump;
    return any;
}

/* Instances go by their objects. */
const struct instance *scene_instance_of(const struct scene *scene, uint32_t object)
{
    size_t first = 0, end = scene->instance_count;
    if (object < scene->world_shape_count)
        return NULL;
    while (end - first > 1) {
        size_t middle = first + (end - first) / 2;
        if (scene->instances[middle].first_object <= object)
            first = middle;
        else
            end = middle;
    }
    return &scene->instances[first];
}

const struct shape *scene_shape_of(const struct scene *scene, uint32_t object)
{
    const struct instance *instance = scene_instance_of(scene, object);
    return instance
               ? &scene->shapes[instance->group->first_shape + (object - instance->first_object)]
               : &scene->shapes[object];
}
