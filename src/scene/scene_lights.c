/* scene_lights.c: the lights of a scene: those described, and what shines by its material. */
#include "scene/scene_parts.h"

#include <psplat/math.h>
#include <stdlib.h>

#define DISC_SEGMENTS 64

bool light_is_lamp(const struct light_description *light)
{
    return light->kind == LIGHT_RECTANGLE || light->kind == LIGHT_DISC ||
           light->kind == LIGHT_SPHERE;
}

bool lamp_describe(const struct light_description *light, struct object_description *object)
{
    *object = (struct object_description){
        .kind = light->kind == LIGHT_SPHERE ? OBJECT_SPHERE : OBJECT_TRIANGLES,
        .placement = AFFINE_IDENTITY,
        .center = light->location,
        .radius = light->radius,
        .hidden = !light->visible,
        .origin = light->origin,
    };
    if (light->kind == LIGHT_SPHERE)
        return true;
    bool disc = light->kind == LIGHT_DISC;
    object->vertex_count = disc ? DISC_SEGMENTS + 1 : 4;
    object->triangle_count = disc ? DISC_SEGMENTS : 2;
    object->vertices = malloc(object->vertex_count * sizeof *object->vertices);
    object->triangles = malloc(object->triangle_count * sizeof *object->triangles);
    if (!object->vertices || !object->triangles) {
        object_description_release(object);
        return false;
    }
    if (disc)
        light_disc_triangles(light, DISC_SEGMENTS, object->vertices, object->triangles);
    else
        light_rectangle_triangles(light, object->vertices, object->triangles);
    return true;
}

/* Keeps an array until the scene is released; NULL stays NULL. */
static void *keep(struct assembly *assembly, void *array)
{
    struct scene *scene = assembly->scene;
    void **owned = realloc(scene->owned, (scene->owned_count + 1) * sizeof *owned);
    if (owned)
        scene->owned = owned;
    else
        error_memory(assembly->error, (scene->owned_count + 1) * sizeof *owned, "the scene");
    if (!array || !owned) {
        free(array);
        return NULL;
    }
    scene->owned[scene->owned_count++] = array;
    return array;
}

/* --- what shines from afar ------------------------------------------------------------------- */

/* The texture as a picture of all directions. */
static bool make_sky_picture(struct assembly *assembly, const struct texture *from,
                             struct sky_picture *picture)
{
    size_t count = (size_t)from->width * from->height;
    float(*rgb)[3] = keep(assembly, assembly_allocate(assembly, count, sizeof *rgb));
    if (!rgb)
        return false;
    for (size_t i = 0; i < count; i++) {
        float rgba[4];
        size_t x = i % from->width, y = i / from->width;
        texture_sample(from, ((float)x + 0.5f) / (float)from->width,
                       1.0f - ((float)y + 0.5f) / (float)from->height, rgba);
        for (int k = 0; k < 3; k++)
            rgb[i][k] = rgba[k];
    }
    *picture = (struct sky_picture){from->width, from->height, (const float(*)[3])rgb};
    return true;
}

static ps_result add_described(struct assembly *assembly, const struct light_description *light)
{
    struct scene *scene = assembly->scene;
    struct light_bounds bounds = {scene->center, scene->radius};
    struct sky_picture picture;
    bool pictured = light->kind == LIGHT_SKY && light->texture != NO_INDEX;
    assembly->where = light->origin;
    if (pictured && !make_sky_picture(assembly, &scene->textures[light->texture], &picture))
        return PS_ERROR_MEMORY;
    ps_result result = light_create(light, &bounds, pictured ? &picture : NULL,
                                    &scene->lights[scene->light_count], assembly->error);
    if (result != PS_OK)
        return result;
    scene->light_count++;
    scene->sky_is_hidden = scene->sky_is_hidden || (light->kind == LIGHT_SKY && !light->visible);
    return PS_OK;
}

/* --- what shines by its material
 * ---------------------------------------------------------------- */

/* Emission that varies over a mesh, looked up where its surface is. */
struct emission_pattern {
    const struct material *material;
    const struct shape *shape;
    struct affine to_shape; /* from world space */
};

static ps_rgb emission_at(const void *user, ps_vec3 position, const struct shape_point *point)
{
    const struct emission_pattern *pattern = user;
    const struct material *material = pattern->material;
    ps_vec3 patterns = affine_point(&pattern->to_shape, position);
    struct opacity_place place = material_opacity_place(material, pattern->shape, point, patterns);
    float coverage = material_coverage(material, &place);
    if (!(coverage > 0.0f))
        return (ps_rgb){0, 0, 0};
    ps_vec3 at = material_texture_point(material, pattern->shape, point, patterns);
    ps_rgb emission = pigment_color(&material->emission, at, place.uv);
    return coverage < 1.0f ? ps_rgb_scale(emission, coverage) : emission;
}

static bool make_pattern(struct assembly *assembly, const struct material *material,
                         const struct shape *shape, const struct instance *instance,
                         struct light_mesh *mesh)
{
    struct emission_pattern *pattern =
        keep(assembly, assembly_allocate(assembly, 1, sizeof *pattern));
    if (!pattern)
        return false;
    *pattern = (struct emission_pattern){material, shape, AFFINE_IDENTITY};
    if (instance)
        affine_invert(&instance->placement, &pattern->to_shape);
    mesh->pattern = emission_at;
    mesh->pattern_user = pattern;
    return true;
}

/* Puts a placed copy of the shape's mesh in the light's; a mirrored one is wound the other way. */
static bool place_mesh(struct assembly *assembly, const struct shape *shape,
                       const struct instance *instance, struct light_mesh *mesh)
{
    ps_vec3 *vertices =
        keep(assembly, assembly_allocate(assembly, shape->vertex_count, sizeof *vertices));
    uint32_t(*triangles)[3] =
        keep(assembly, assembly_allocate(assembly, shape->triangle_count, sizeof *triangles));
    if (!vertices || !triangles)
        return false;
    for (size_t i = 0; i < shape->vertex_count; i++)
        vertices[i] = affine_point(&instance->placement, shape->vertices[i]);
    bool mirrored = instance->front < 0.0f;
    for (size_t i = 0; i < shape->triangle_count; i++) {
        triangles[i][0] = shape->triangles[i][0];
        triangles[i][1] = shape->triangles[i][mirrored ? 2 : 1];
        triangles[i][2] = shape->triangles[i][mirrored ? 1 : 2];
    }
    mesh->vertices = vertices;
    mesh->triangles = (const uint32_t(*)[3])triangles;
    return true;
}

/* A mesh in world space: the shape's own, or a placed copy. */
static ps_result add_mesh(struct assembly *assembly, const struct shape *shape,
                          const struct instance *instance, const struct material *material)
{
    struct scene *scene = assembly->scene;
    struct light_mesh mesh = {
        .vertices = shape->vertices,
        .triangles = (const uint32_t(*)[3])shape->triangles,
        .triangle_count = shape->triangle_count,
    };
    bool patterned = !pigment_is_constant(&material->emission) || material->has_opacity;
    if (patterned && !make_pattern(assembly, material, shape, instance, &mesh))
        return PS_ERROR_MEMORY;
    if (instance && !place_mesh(assembly, shape, instance, &mesh))
        return PS_ERROR_MEMORY;
    static const float corner[2] = {0, 0};
    ps_rgb radiance = patterned ? (ps_rgb){1, 1, 1}
                                : pigment_color(&material->emission, (ps_vec3){0, 0, 0}, corner);
    return light_create_mesh(&mesh, radiance, material->emission_both,
                             &scene->lights[scene->light_count], assembly->error);
}

/* Whether the placement keeps spheres. */
static bool is_even(const struct affine *placement)
{
    float x = ps_length(placement->x), y = ps_length(placement->y), z = ps_length(placement->z);
    return fabsf(x - y) <= 1e-4f * x && fabsf(x - z) <= 1e-4f * x;
}

static ps_result add_sphere(struct assembly *assembly, const struct shape *shape,
                            const struct instance *instance, const struct material *material)
{
    struct scene *scene = assembly->scene;
    static const float middle[2] = {0.5f, 0.5f};
    ps_vec3 center = shape->center;
    float radius = shape->radius;
    if (!pigment_is_constant(&material->emission))
        return error_set(assembly->error, PS_ERROR_INVALID,
                         "a sphere can only shine in one colour; use another shape");
    if (material->has_opacity)
        return error_set(assembly->error, PS_ERROR_INVALID,
                         "a sphere that shines can't have holes; use another shape");
    if (instance && !is_even(&instance->placement))
        return error_set(assembly->error, PS_ERROR_INVALID,
                         "a sphere that shines is scaled unevenly by the instance it stands in");
    if (instance) {
        center = affine_point(&instance->placement, center);
        radius *= ps_length(instance->placement.x);
    }
    scene->lights[scene->light_count] =
        light_create_sphere(center, radius, pigment_color(&material->emission, center, middle),
                            material->emission_both);
    return PS_OK;
}

static ps_result add_object(struct assembly *assembly, uint32_t object, const struct shape *shape,
                            const struct instance *instance)
{
    struct scene *scene = assembly->scene;
    bool other = instance && instance->material != NO_MATERIAL;
    const struct material *material =
        &scene->materials[other ? instance->material : shape->material];
    scene->object_lights[object] = NO_LIGHT;
    if (!material->emissive)
        return PS_OK;
    ps_result result = shape->kind == SHAPE_MESH ? add_mesh(assembly, shape, instance, material)
                                                 : add_sphere(assembly, shape, instance, material);
    if (result == PS_OK)
        scene->object_lights[object] = (uint32_t)scene->light_count++;
    return result;
}

static ps_result add_emissive(struct assembly *assembly)
{
    struct scene *scene = assembly->scene;
    ps_result result = PS_OK;
    for (uint32_t i = 0; i < scene->world_shape_count && result == PS_OK; i++)
        result = add_object(assembly, i, &scene->shapes[i], NULL);
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct instance *instance = &scene->instances[i];
        for (uint32_t k = 0; k < instance->group->shape_count && result == PS_OK; k++)
            result = add_object(assembly, instance->first_object + k,
                                &scene->shapes[instance->group->first_shape + k], instance);
    }
    return result;
}

/* --- choosing --------------------------------------------------------------------------------- */

/* Lights share the light paths by power, the sum of its red, green and blue; a scene whose lights
 * are all dark shares them evenly. */
static ps_result share_paths(struct assembly *assembly)
{
    struct scene *scene = assembly->scene;
    if (scene->light_count == 0)
        return PS_OK;
    float *powers = assembly_allocate(assembly, scene->light_count, sizeof *powers);
    if (!powers)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < scene->light_count; i++) {
        ps_rgb power = light_power(&scene->lights[i]);
        powers[i] = power.r + power.g + power.b;
        scene->has_area_lights = scene->has_area_lights || !light_is_delta(&scene->lights[i]);
    }
    ps_result result =
        distribution_create(powers, scene->light_count, &scene->light_choice, assembly->error);
    free(powers);
    return result;
}

/* Sun and sky by themselves, and a tree of the others. */
static ps_result arrange_lights(struct assembly *assembly)
{
    struct scene *scene = assembly->scene;
    scene->afar = assembly_allocate(assembly, scene->light_count, sizeof *scene->afar);
    if (!scene->afar)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < scene->light_count; i++)
        if (light_is_afar(&scene->lights[i]))
            scene->afar[scene->afar_count++] = (uint32_t)i;
    ps_result result =
        light_bvh_create(scene->lights, scene->light_count, &scene->light_bvh, assembly->error);
    for (size_t i = 0; i < scene->light_count && result == PS_OK; i++)
        scene->has_split_lights =
            scene->has_split_lights || light_bvh_is_split(scene->light_bvh, i);
    return result;
}

ps_result assembly_add_lights(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    size_t most = description->light_count + scene->object_count;
    scene->lights = assembly_allocate(assembly, most, sizeof *scene->lights);
    scene->object_lights =
        assembly_allocate(assembly, scene->object_count, sizeof *scene->object_lights);
    if (!scene->lights || !scene->object_lights)
        return PS_ERROR_MEMORY;
    ps_result result = PS_OK;
    for (size_t i = 0; i < description->light_count && result == PS_OK; i++)
        if (!light_is_lamp(&description->lights[i]))
            result = add_described(assembly, &description->lights[i]);
    if (result == PS_OK)
        result = add_emissive(assembly);
    if (result == PS_OK)
        result = arrange_lights(assembly);
    return result == PS_OK ? share_paths(assembly) : result;
}

bool scene_chooses_lights(const struct scene *scene)
{
    return light_bvh_is_chosen_from(scene->light_bvh, scene->light_choices);
}

bool scene_has_sky(const struct scene *scene)
{
    for (size_t i = 0; i < scene->afar_count; i++)
        if (scene->lights[scene->afar[i]].emitter == EMITTER_SKY)
            return true;
    return false;
}

bool scene_has_delta_lamps(const struct scene *scene)
{
    for (size_t i = 0; i < scene->light_count; i++)
        if (scene->lights[i].emitter == EMITTER_SPOT)
            return true;
    return false;
}

bool scene_samples_lights(const struct scene *scene)
{
    return scene->has_area_lights || scene_chooses_lights(scene);
}

/* 1 - cos of half of five degrees. */
#define HARD_SUN 9.52e-4f

bool scene_light_casts_hard_shadows(const struct scene *scene, size_t light)
{
    const struct light *asked = &scene->lights[light];
    bool is_asked = light_is_afar(asked) || !scene_chooses_lights(scene);
    bool is_small_sun = asked->emitter == EMITTER_SUN && asked->sun.versine <= HARD_SUN;
    return is_asked && (light_is_delta(asked) || is_small_sun);
}

bool scene_has_hard_shadows_apart(const struct scene *scene)
{
    bool any = false;
    for (size_t i = 0; i < scene->light_count && !any; i++)
        any = scene_light_casts_hard_shadows(scene, i);
    return any && scene_samples_lights(scene);
}

size_t scene_choose_light(const struct scene *scene, float *u, float *probability)
{
    size_t light = distribution_choose(&scene->light_choice, *u, u);
    *probability = distribution_probability(&scene->light_choice, light);
    return light;
}
