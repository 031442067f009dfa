#include "scene/transfer.h"

#include <assert.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void transfer_bytes(struct transfer *transfer, void *bytes, size_t size)
{
    if (!transfer->failed && size > 0)
        transfer->failed = !transfer->move(transfer->user, bytes, size);
}

/* The array that *member, a pointer to any kind of object, owns; NULL stays NULL. */
static void move_array(struct transfer *transfer, void *member, size_t count, size_t size)
{
    assert(size > 0);
    void *items;
    memcpy(&items, member, sizeof items);
    if (!items)
        return;
    if (transfer->receives) {
        items = transfer->failed || count > SIZE_MAX / size ? NULL : malloc(count * size + 1);
        transfer->failed |= !items;
    }
    transfer_bytes(transfer, items, count * size);
    if (transfer->receives && transfer->failed) {
        free(items);
        items = NULL;
    }
    memcpy(member, &items, sizeof items);
}

void transfer_structs(struct transfer *transfer, void *member, size_t *count, size_t size)
{
    move_array(transfer, member, *count, size);
    if (transfer->receives && transfer->failed)
        *count = 0;
}

void transfer_text(struct transfer *transfer, char **text)
{
    size_t size = *text && !transfer->receives ? strlen(*text) + 1 : 0;
    if (*text)
        transfer_bytes(transfer, &size, sizeof size);
    move_array(transfer, text, size, 1);
}

/* --- the walk
 * -------------------------------------------------------------------------------------- */

static void move_cameras(struct transfer *transfer, struct scene_description *description)
{
    transfer_structs(transfer, &description->cameras, &description->camera_count,
                     sizeof *description->cameras);
    for (size_t i = 0; i < description->camera_count; i++)
        transfer_text(transfer, &description->cameras[i].name);
}

static void move_textures(struct transfer *transfer, struct scene_description *description)
{
    transfer_structs(transfer, &description->textures, &description->texture_count,
                     sizeof *description->textures);
    for (size_t i = 0; i < description->texture_count; i++) {
        struct texture_description *texture = &description->textures[i];
        transfer_text(transfer, &texture->path);
        transfer_text(transfer, &texture->layer);
        move_array(transfer, &texture->bytes, texture->byte_count, 1);
    }
}

static void move_materials(struct transfer *transfer, struct scene_description *description)
{
    transfer_structs(transfer, &description->materials, &description->material_count,
                     sizeof *description->materials);
    for (size_t i = 0; i < description->material_count; i++) {
        struct material_description *material = &description->materials[i];
        transfer_text(transfer, &material->name);
        move_array(transfer, &material->components, material->component_count,
                   sizeof *material->components);
        move_array(transfer, &material->weights, material->component_count,
                   sizeof *material->weights);
    }
}

static void move_meshes(struct transfer *transfer, struct scene_description *description)
{
    transfer_structs(transfer, &description->meshes, &description->mesh_count,
                     sizeof *description->meshes);
    for (size_t i = 0; i < description->mesh_count; i++) {
        struct mesh_description *mesh = &description->meshes[i];
        move_array(transfer, &mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
        move_array(transfer, &mesh->normals, mesh->vertex_count, sizeof *mesh->normals);
        move_array(transfer, &mesh->uv, mesh->vertex_count, sizeof *mesh->uv);
        move_array(transfer, &mesh->second_uv, mesh->vertex_count, sizeof *mesh->second_uv);
        move_array(transfer, &mesh->colors, mesh->vertex_count, sizeof *mesh->colors);
        move_array(transfer, &mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
    }
}

static void move_objects(struct transfer *transfer, struct object_description **objects,
                         size_t *count)
{
    transfer_structs(transfer, objects, count, sizeof **objects);
    for (size_t i = 0; i < *count; i++) {
        struct object_description *object = &(*objects)[i];
        move_array(transfer, &object->vertices, object->vertex_count, sizeof *object->vertices);
        move_array(transfer, &object->triangles, object->triangle_count, sizeof *object->triangles);
    }
}

static void move_groups(struct transfer *transfer, struct scene_description *description)
{
    transfer_structs(transfer, &description->groups, &description->group_count,
                     sizeof *description->groups);
    for (size_t i = 0; i < description->group_count; i++) {
        struct group_description *group = &description->groups[i];
        transfer_text(transfer, &group->name);
        move_objects(transfer, &group->objects, &group->object_count);
    }
}

static void move_render(struct transfer *transfer, struct render_description *render)
{
    for (int kind = 0; kind < PS_KINDS; kind++) {
        struct strategy_choice *choice = &render->strategies[kind];
        transfer_text(transfer, &choice->name);
        transfer_structs(transfer, &choice->parameters, &choice->parameter_count,
                         sizeof *choice->parameters);
        for (size_t i = 0; i < choice->parameter_count; i++) {
            transfer_text(transfer, &choice->parameters[i].key);
            transfer_text(transfer, &choice->parameters[i].value);
        }
    }
}

static void move_files(struct transfer *transfer, struct scene_description *description)
{
    transfer_structs(transfer, &description->files, &description->file_count,
                     sizeof *description->files);
    for (size_t i = 0; i < description->file_count; i++)
        transfer_text(transfer, &description->files[i]);
}

void transfer_description(struct transfer *transfer, struct scene_description *description)
{
    transfer_text(transfer, &description->path);
    transfer_text(transfer, &description->folder);
    transfer_text(transfer, &description->cache);
    transfer_bytes(transfer, &description->texture_memory, sizeof description->texture_memory);
    transfer_bytes(transfer, &description->memory_limit, sizeof description->memory_limit);
    move_cameras(transfer, description);
    move_textures(transfer, description);
    move_materials(transfer, description);
    transfer_structs(transfer, &description->lights, &description->light_count,
                     sizeof *description->lights);
    move_meshes(transfer, description);
    move_groups(transfer, description);
    move_objects(transfer, &description->objects, &description->object_count);
    move_render(transfer, &description->render);
    move_files(transfer, description);
}

/* --- names
 * ----------------------------------------------------------------------------------------- */

struct naming {
    const struct scene_description *description;
    const char *const *old;
    size_t last; /* found; most often the next one, too */
};

static void rename_one(struct naming *naming, const char **name)
{
    size_t count = naming->description->file_count;
    for (size_t i = 0; *name && i < count; i++) {
        size_t index = (naming->last + i) % count;
        if (naming->old[index] == *name) {
            naming->last = index;
            *name = naming->description->files[index];
            return;
        }
    }
    *name = NULL;
}

static void rename_objects(struct naming *naming, struct object_description *objects, size_t count)
{
    for (size_t i = 0; i < count; i++)
        rename_one(naming, &objects[i].origin.file);
}

static void rename_choice(struct naming *naming, struct strategy_choice *choice)
{
    rename_one(naming, &choice->origin.file);
    for (size_t i = 0; i < choice->parameter_count; i++) {
        rename_one(naming, &choice->parameters[i].key_origin.file);
        rename_one(naming, &choice->parameters[i].value_origin.file);
    }
}

void transfer_names(struct scene_description *description, const char *const old[])
{
    struct naming naming = {.description = description, .old = old};
    rename_one(&naming, &description->image.origin.file);
    for (size_t i = 0; i < description->camera_count; i++)
        rename_one(&naming, &description->cameras[i].origin.file);
    for (size_t i = 0; i < description->texture_count; i++)
        rename_one(&naming, &description->textures[i].origin.file);
    for (size_t i = 0; i < description->material_count; i++)
        rename_one(&naming, &description->materials[i].origin.file);
    for (size_t i = 0; i < description->light_count; i++)
        rename_one(&naming, &description->lights[i].origin.file);
    for (size_t i = 0; i < description->mesh_count; i++)
        rename_one(&naming, &description->meshes[i].file);
    for (size_t i = 0; i < description->group_count; i++)
        rename_objects(&naming, description->groups[i].objects,
                       description->groups[i].object_count);
    rename_objects(&naming, description->objects, description->object_count);
    for (int kind = 0; kind < PS_KINDS; kind++)
        rename_choice(&naming, &description->render.strategies[kind]);
}
