#include "scene/scene.h"

#include "scene/shape.h"
#include <psplat/math.h>
#include <stdlib.h>

/* Rays start this many units in the last place of the largest coordinate off their surface: enough
 * for the rounding of a hit point, too little to see. */
#define OFFSET_ULPS 32.0f

/* Outside of these the ray tracer's single precision squares to nothing or infinity. */
#define SMALLEST_RADIUS 1e-6f
#define LARGEST_RADIUS 1e9f

static void *allocate_array(size_t count, size_t size)
{
    return calloc(count ? count : 1, size);
}

static ps_result allocate_members(const struct scene_description *description, struct scene *scene,
                                  struct error *error)
{
    scene->shapes = allocate_array(description->object_count, sizeof *scene->shapes);
    scene->materials = allocate_array(description->material_count, sizeof *scene->materials);
    scene->lights = allocate_array(description->light_count, sizeof *scene->lights);
    scene->light_cdf = allocate_array(description->light_count, sizeof *scene->light_cdf);
    if (scene->shapes && scene->materials && scene->lights && scene->light_cdf)
        return PS_OK;
    return error_memory(error, description->object_count * sizeof *scene->shapes, "the scene");
}

static ps_result create_shapes(const struct scene_description *description, struct scene *scene,
                               struct error *error)
{
    const struct shape_surroundings surroundings = {.meshes = description->meshes};
    for (size_t i = 0; i < description->object_count; i++) {
        ps_result result =
            shape_create(&description->objects[i], &surroundings, &scene->shapes[i], error);
        if (result != PS_OK)
            return result;
        scene->shape_count++;
    }
    return PS_OK;
}

/* Lights share the light paths by power; a scene whose lights are all dark shares them evenly. */
static void create_lights(const struct scene_description *description, struct scene *scene)
{
    scene->light_count = description->light_count;
    float total = 0.0f;
    for (size_t i = 0; i < scene->light_count; i++) {
        scene->lights[i] = light_from_description(&description->lights[i]);
        ps_rgb power = light_power(&scene->lights[i]);
        total += power.r + power.g + power.b;
        scene->light_cdf[i] = total;
    }
    for (size_t i = 0; i < scene->light_count; i++)
        scene->light_cdf[i] =
            total > 0.0f ? scene->light_cdf[i] / total : (float)(i + 1) / (float)scene->light_count;
}

static void measure(struct scene *scene)
{
    ps_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < scene->shape_count; i++)
        shape_extend_bounds(&scene->shapes[i], &low, &high);
    if (!(low.x <= high.x))
        low = high = (ps_vec3){0, 0, 0};
    scene->center = ps_scale(ps_add(low, high), 0.5f);
    scene->radius = 0.5f * ps_length(ps_subtract(high, low));
    float largest = scene->radius + ps_length(scene->center);
    scene->surface_offset = OFFSET_ULPS * 0x1p-23f * largest;
}

ps_result scene_create(const struct scene_description *description, struct scene *scene,
                       struct error *error)
{
    *scene = (struct scene){
        .width = (size_t)description->image.width,
        .height = (size_t)description->image.height,
    };
    ps_result result = allocate_members(description, scene, error);
    if (result == PS_OK)
        result = create_shapes(description, scene, error);
    if (result != PS_OK) {
        scene_release(scene);
        return result;
    }
    scene->material_count = description->material_count;
    for (size_t i = 0; i < scene->material_count; i++)
        scene->materials[i].diffuse = description->materials[i].color.colors[0];
    create_lights(description, scene);
    scene->camera = camera_from_description(&description->cameras[0], scene->width, scene->height);
    measure(scene);
    if (scene->shape_count == 0 ||
        (scene->radius > SMALLEST_RADIUS && scene->radius < LARGEST_RADIUS))
        return PS_OK;
    result = error_set(error, PS_ERROR_INVALID,
                       "the scene's radius is %g units; choose units that bring it within %g..%g",
                       (double)scene->radius, (double)SMALLEST_RADIUS, (double)LARGEST_RADIUS);
    scene_release(scene);
    return result;
}

void scene_release(struct scene *scene)
{
    for (size_t i = 0; i < scene->shape_count; i++)
        shape_release(&scene->shapes[i]);
    free(scene->shapes);
    free(scene->materials);
    free(scene->lights);
    free(scene->light_cdf);
    *scene = (struct scene){.shapes = NULL};
}

size_t scene_choose_light(const struct scene *scene, float u, float *probability)
{
    size_t i = 0;
    while (i + 1 < scene->light_count && u >= scene->light_cdf[i])
        i++;
    *probability = scene->light_cdf[i] - (i ? scene->light_cdf[i - 1] : 0.0f);
    return i;
}
