/* scene_materials.c: textures and materials of a scene. */
#include "base/machine.h"
#include "base/text.h"
#include "scene/scene_parts.h"

#include <psplat/math.h>
#include <stdlib.h>

/* Of what a file of its size would hardly hold, as a flat WebP: many small files must not take all
 * memory. */
#define EXPANSION 4096
#define EXCESS_LIMIT ((size_t)1 << 30)

/* That pictures may take, where nothing else is said. */
#define SHARE_OF_MEMORY 0.5

static ps_result count_excess(struct assembly *assembly, const struct raster *raster,
                              size_t *excess)
{
    size_t bytes = raster_bytes(raster), expected = raster->file_size * EXPANSION;
    *excess += bytes > expected ? bytes - expected : 0;
    if (*excess <= EXCESS_LIMIT)
        return PS_OK;
    return error_set(assembly->error, PS_ERROR_INVALID,
                     "the scene's textures take 1 GiB more than %d times their files", EXPANSION);
}

/* That pictures may take. */
static double texture_memory(const struct scene_description *description)
{
    double given = description->texture_memory;
    return given > 0.0 ? given : SHARE_OF_MEMORY * machine_memory_within(description->memory_limit);
}

static ps_result check_memory(const struct assembly *assembly, double taken, double most)
{
    if (taken <= most)
        return PS_OK;
    char all[TEXT_SIZE_LENGTH], limit[TEXT_SIZE_LENGTH];
    return error_set(assembly->error, PS_ERROR_MEMORY,
                     "up to this one the scene's pictures take %s of memory, and --texture-memory "
                     "is %s%s",
                     text_of_size(taken, all), text_of_size(most, limit),
                     assembly->description->cache
                         ? ""
                         : "; with --cache large ones are read in tiles, as they are looked at");
}

/* Marks the textures that materials take, which rays filter; skies are looked up at points. */
static void mark_filtered(const struct scene_description *description, bool *filtered)
{
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    for (size_t i = 0; i < description->material_count; i++) {
        material_pigments(&description->materials[i], pigments);
        for (size_t k = 0; k < MATERIAL_PIGMENTS; k++)
            if (pigments[k]->kind == PIGMENT_IMAGE)
                filtered[pigments[k]->texture] = true;
    }
}

static ps_result load_all(struct assembly *assembly, struct texture_storage *storage, double most,
                          const bool *filtered)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    size_t excess = 0;
    double taken = 0.0;
    for (size_t i = 0; i < description->texture_count; i++) {
        assembly->where = description->textures[i].origin;
        storage->mip_maps = filtered[i];
        ps_result result =
            texture_load(&description->textures[i], storage, &scene->textures[i], assembly->error);
        if (result != PS_OK)
            return result;
        scene->texture_count++;
        taken += (double)texture_bytes(&scene->textures[i]);
        result = count_excess(assembly, &scene->textures[i].raster, &excess);
        if (result == PS_OK)
            result = check_memory(assembly, taken, most);
        if (result != PS_OK)
            return result;
    }
    return PS_OK;
}

static ps_result load_textures(struct assembly *assembly)
{
    const struct scene_description *description = assembly->description;
    struct scene *scene = assembly->scene;
    size_t count = description->texture_count;
    double most = texture_memory(description);
    struct texture_storage storage = {.folder = description->folder, .cache = description->cache};
    if (description->cache && count > 0) {
        storage.budget = scene->texture_memory = mapped_budget_create(most);
        if (!storage.budget)
            return error_memory(assembly->error, sizeof(void *), "the textures' cache");
    }
    scene->textures = assembly_allocate(assembly, count, sizeof *scene->textures);
    bool *filtered = scene->textures ? assembly_allocate(assembly, count, sizeof *filtered) : NULL;
    if (!filtered)
        return PS_ERROR_MEMORY;
    mark_filtered(description, filtered);
    ps_result result = load_all(assembly, &storage, most, filtered);
    free(filtered);
    return result;
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
    for (size_t i = 0; specular && i < description->material_count; i++)
        material_tabulate(&scene->materials[i], scene->microfacets);
    return PS_OK;
}
