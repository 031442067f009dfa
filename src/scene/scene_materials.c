/* scene_materials.c: textures and materials of a scene. */
#include "scene/scene_parts.h"

#include <psplat/math.h>
#include <stdlib.h>

static ps_result load_textures(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    scene->textures =
        assembly_allocate(assembly, description->texture_count, sizeof *scene->textures);
    if (!scene->textures)
        return PS_ERROR_MEMORY;
    for (size_t i = 0; i < description->texture_count; i++) {
        assembly->where = description->textures[i].origin;
        ps_result result = texture_load(&description->textures[i], description->folder,
                                        &scene->textures[i], assembly->error);
        if (result != PS_OK)
            return result;
        scene->texture_count++;
    }
    return PS_OK;
}

/* Lookups keep reflectances within 0..1 (pigment.h); here is noted which pictures that changes. */
static void note_clipped(struct scene *scene, const struct material_description *material)
{
    const struct pigment_description *reflectances[] = {&material->color, &material->specular};
    for (size_t i = 0; i < sizeof reflectances / sizeof reflectances[0]; i++) {
        const struct pigment_description *pigment = reflectances[i];
        if (pigment->kind != PIGMENT_IMAGE)
            continue;
        struct texture *texture = &scene->textures[pigment->texture];
        texture->clipped =
            texture->clipped || texture_leaves_range(texture, ps_rgb_maximum(pigment->colors[0]));
    }
}

/* Lights shine by materials of their own, whose radiance is known when they have a shape. */
static size_t count_lamps(const struct scene_description *description)
{
    size_t count = 0;
    for (size_t i = 0; i < description->light_count; i++)
        count += light_is_lamp(&description->lights[i]);
    return count;
}

ps_result assembly_add_materials(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    ps_result result = load_textures(assembly);
    if (result != PS_OK)
        return result;
    size_t count = description->material_count + count_lamps(description);
    scene->materials = assembly_allocate(assembly, count, sizeof *scene->materials);
    if (!scene->materials)
        return PS_ERROR_MEMORY;
    bool specular = false;
    for (size_t i = 0; i < description->material_count; i++) {
        assembly->where = description->materials[i].origin;
        result =
            material_create(description, i, scene->textures, &scene->materials[i], assembly->error);
        if (result != PS_OK)
            return result;
        specular = specular || scene->materials[i].specular;
        note_clipped(scene, &description->materials[i]);
    }
    scene->material_count = count;
    if (specular)
        scene->microfacets = assembly_allocate(assembly, 1, sizeof *scene->microfacets);
    if (specular && !scene->microfacets)
        return PS_ERROR_MEMORY;
    if (specular)
        microfacet_tabulate(scene->microfacets);
    return PS_OK;
}
