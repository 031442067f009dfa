/* fragment.c: joins what a mesh file brought with the description. */
#include "parser/sections/object.h"

#include "import/import.h"
#include "parser/sections/sections.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where the fragment's materials, textures and meshes go in the description. */
struct joint {
    struct reader *reader;
    const struct fragment *fragment;
    size_t *materials, *textures; /* NO_INDEX: not yet, or never */
    size_t first_mesh;
    size_t plain; /* the material of objects without any; NO_INDEX: not needed yet */
};

/* Room for one more; NULL, noted, when out of memory. */
static struct material_description *add_material(struct reader *reader)
{
    struct scene_description *description = reader->description;
    struct material_description *materials = reader_extend(
        reader, description->materials, description->material_count, 1, sizeof *materials);
    if (!materials)
        return NULL;
    description->materials = materials;
    return &materials[description->material_count++];
}

static size_t move_texture(struct joint *joint, size_t index)
{
    struct scene_description *content = joint->fragment->content;
    if (index == NO_INDEX || joint->textures[index] != NO_INDEX)
        return index == NO_INDEX ? NO_INDEX : joint->textures[index];
    struct scene_description *description = joint->reader->description;
    struct texture_description *textures = reader_extend(
        joint->reader, description->textures, description->texture_count, 1, sizeof *textures);
    if (!textures)
        return NO_INDEX;
    description->textures = textures;
    textures[description->texture_count] = content->textures[index];
    content->textures[index] = (struct texture_description){.path = NULL};
    return joint->textures[index] = description->texture_count++;
}

static void move_pigment(struct joint *joint, struct pigment_description *pigment)
{
    if (pigment->kind == PIGMENT_IMAGE)
        pigment->texture = move_texture(joint, pigment->texture);
}

static size_t move_material(struct joint *joint, size_t index);

/* The parts of a mix come before it; they are no mixes themselves. */
static bool move_components(struct joint *joint, struct material_description *mix)
{
    for (size_t i = 0; i < mix->component_count; i++) {
        mix->components[i] = move_material(joint, mix->components[i]);
        if (mix->components[i] == NO_INDEX)
            return false;
    }
    return true;
}

static size_t move_material(struct joint *joint, size_t index)
{
    struct scene_description *content = joint->fragment->content;
    if (joint->materials[index] != NO_INDEX)
        return joint->materials[index];
    if (!move_components(joint, &content->materials[index]))
        return NO_INDEX;
    struct material_description *material = add_material(joint->reader);
    if (!material)
        return NO_INDEX;
    *material = content->materials[index];
    content->materials[index] = (struct material_description){.name = NULL};
    joint->materials[index] = joint->reader->description->material_count - 1;
    struct pigment_description *pigments[MATERIAL_PIGMENTS];
    material_pigments(material, pigments);
    for (size_t i = 0; i < MATERIAL_PIGMENTS; i++)
        move_pigment(joint, pigments[i]);
    return joint->materials[index];
}

static size_t plain_material(struct joint *joint, const struct node *at)
{
    struct material_description *material =
        joint->plain == NO_INDEX ? add_material(joint->reader) : NULL;
    if (material) {
        *material = mesh_material_plain(reader_origin(joint->reader, at));
        joint->plain = joint->reader->description->material_count - 1;
    }
    return joint->plain;
}

static size_t choose_material(struct joint *joint, size_t index)
{
    const struct fragment *fragment = joint->fragment;
    if (index != NO_INDEX && fragment->replacements[index] != NO_INDEX)
        return fragment->replacements[index];
    if (fragment->otherwise != NO_INDEX || index == NO_INDEX || !fragment->keep_materials ||
        material_is_absent(&fragment->content->materials[index]))
        return fragment->otherwise;
    return move_material(joint, index);
}

static void move_meshes(struct joint *joint)
{
    struct scene_description *content = joint->fragment->content;
    struct scene_description *description = joint->reader->description;
    size_t first = joint->first_mesh = description->mesh_count;
    struct mesh_description *meshes = reader_extend(joint->reader, description->meshes, first,
                                                    content->mesh_count, sizeof *meshes);
    if (!meshes)
        return;
    description->meshes = meshes;
    description->mesh_count += content->mesh_count;
    memcpy(meshes + first, content->meshes, content->mesh_count * sizeof *meshes);
    content->mesh_count = 0;
}

static size_t move_objects(struct joint *joint, const struct node *at,
                           const struct object_context *context)
{
    const struct scene_description *content = joint->fragment->content;
    size_t plain = 0;
    for (size_t i = 0; i < content->object_count && !joint->reader->out_of_memory; i++) {
        struct object_description object = content->objects[i];
        object.material = choose_material(joint, object.material);
        object.mesh += joint->first_mesh;
        if (object.material == NO_INDEX) {
            object.material = plain_material(joint, at);
            plain++;
        }
        if (object.material == NO_INDEX || !object_append(joint->reader, at, context, &object))
            break;
    }
    return plain;
}

static void move_lights(struct joint *joint)
{
    struct scene_description *content = joint->fragment->content;
    struct scene_description *description = joint->reader->description;
    struct light_description *lights =
        reader_extend(joint->reader, description->lights, description->light_count,
                      content->light_count, sizeof *lights);
    if (!lights)
        return;
    description->lights = lights;
    lights += description->light_count;
    description->light_count += content->light_count;
    memcpy(lights, content->lights, content->light_count * sizeof *lights);
    for (size_t i = 0; i < content->light_count; i++)
        lights[i].texture = move_texture(joint, lights[i].texture);
    content->light_count = 0;
}

/* "camera", "camera 2", "camera 3", ... */
static char *unused_name(struct reader *reader, const char *name)
{
    char numbered[256];
    snprintf(numbered, sizeof numbered, "%s", name);
    for (size_t i = 2; camera_exists(reader, numbered); i++)
        snprintf(numbered, sizeof numbered, "%.200s %zu", name, i);
    return reader_copy(reader, numbered);
}

static void move_cameras(struct reader *reader, struct scene_description *content)
{
    for (size_t i = 0; i < content->camera_count; i++) {
        const char *name = content->cameras[i].name ? content->cameras[i].name : "camera";
        char *unused = unused_name(reader, name);
        struct camera_description *camera = camera_add(reader);
        if (!camera) {
            free(unused);
            return;
        }
        *camera = content->cameras[i];
        camera->name = unused;
    }
}

static size_t *none(struct reader *reader, size_t count)
{
    size_t *indices = reader_allocate(reader, count + 1, sizeof *indices);
    for (size_t i = 0; indices && i < count; i++)
        indices[i] = NO_INDEX;
    return indices;
}

size_t fragment_append(struct reader *reader, const struct node *at,
                       const struct fragment *fragment, const struct object_context *context)
{
    struct joint joint = {
        .reader = reader,
        .fragment = fragment,
        .materials = none(reader, fragment->content->material_count),
        .textures = none(reader, fragment->content->texture_count),
        .plain = NO_INDEX,
    };
    size_t plain = 0;
    if (joint.materials && joint.textures) {
        if (fragment->content->mesh_count > 0)
            move_meshes(&joint);
        plain = move_objects(&joint, at, context);
        if (fragment->content->light_count > 0)
            move_lights(&joint);
        move_cameras(reader, fragment->content);
    }
    free(joint.materials);
    free(joint.textures);
    return plain;
}
