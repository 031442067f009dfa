/* transfer.c: the walk over what a mesh file can hold. */
#include "import/transfer.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int mesh_transfer_open(void)
{
#ifdef MFD_CLOEXEC
    return memfd_create("mesh", MFD_CLOEXEC);
#else
    FILE *stream = tmpfile();
    int file = stream ? dup(fileno(stream)) : -1;
    if (stream)
        fclose(stream);
    return file;
#endif
}

struct transfer {
    int file;
    bool receives;
    bool failed; /* nothing more is moved, and pointers that were not received become NULL */
};

static void move_bytes(struct transfer *transfer, void *bytes, size_t size)
{
    char *at = bytes;
    while (size > 0 && !transfer->failed) {
        ssize_t moved =
            transfer->receives ? read(transfer->file, at, size) : write(transfer->file, at, size);
        if (moved > 0) {
            at += moved;
            size -= (size_t)moved;
        } else if (moved == 0 || errno != EINTR) {
            transfer->failed = true;
        }
    }
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
    move_bytes(transfer, items, count * size);
    if (transfer->receives && transfer->failed) {
        free(items);
        items = NULL;
    }
    memcpy(member, &items, sizeof items);
}

/* An array of structs that own others. */
static void move_structs(struct transfer *transfer, void *member, size_t *count, size_t size)
{
    move_array(transfer, member, *count, size);
    if (transfer->receives && transfer->failed)
        *count = 0;
}

static void move_text(struct transfer *transfer, char **text)
{
    size_t size = *text && !transfer->receives ? strlen(*text) + 1 : 0;
    if (*text)
        move_bytes(transfer, &size, sizeof size);
    move_array(transfer, text, size, 1);
}

static void move_materials(struct transfer *transfer, struct scene_description *fragment)
{
    move_structs(transfer, &fragment->materials, &fragment->material_count,
                 sizeof *fragment->materials);
    for (size_t i = 0; i < fragment->material_count; i++) {
        struct material_description *material = &fragment->materials[i];
        move_text(transfer, &material->name);
        move_array(transfer, &material->components, material->component_count,
                   sizeof *material->components);
        move_array(transfer, &material->weights, material->component_count,
                   sizeof *material->weights);
    }
}

static void move_meshes(struct transfer *transfer, struct scene_description *fragment)
{
    move_structs(transfer, &fragment->meshes, &fragment->mesh_count, sizeof *fragment->meshes);
    for (size_t i = 0; i < fragment->mesh_count; i++) {
        struct mesh_description *mesh = &fragment->meshes[i];
        move_array(transfer, &mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
        move_array(transfer, &mesh->normals, mesh->vertex_count, sizeof *mesh->normals);
        move_array(transfer, &mesh->uv, mesh->vertex_count, sizeof *mesh->uv);
        move_array(transfer, &mesh->second_uv, mesh->vertex_count, sizeof *mesh->second_uv);
        move_array(transfer, &mesh->colors, mesh->vertex_count, sizeof *mesh->colors);
        move_array(transfer, &mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
    }
}

static void move_textures(struct transfer *transfer, struct scene_description *fragment)
{
    move_structs(transfer, &fragment->textures, &fragment->texture_count,
                 sizeof *fragment->textures);
    for (size_t i = 0; i < fragment->texture_count; i++) {
        struct texture_description *texture = &fragment->textures[i];
        move_text(transfer, &texture->path);
        move_array(transfer, &texture->bytes, texture->byte_count, 1);
    }
}

static void move_cameras(struct transfer *transfer, struct scene_description *fragment)
{
    move_structs(transfer, &fragment->cameras, &fragment->camera_count, sizeof *fragment->cameras);
    for (size_t i = 0; i < fragment->camera_count; i++)
        move_text(transfer, &fragment->cameras[i].name);
}

static void move_looks(struct transfer *transfer, struct mesh_looks *looks)
{
    move_structs(transfer, &looks->items, &looks->count, sizeof *looks->items);
    for (size_t i = 0; i < looks->count; i++)
        move_text(transfer, &looks->items[i].path);
}

/* Of a mesh file, lights and objects own nothing. */
static void move_outcome(struct transfer *transfer, struct mesh_outcome *outcome)
{
    struct scene_description *fragment = &outcome->fragment;
    move_bytes(transfer, outcome, sizeof *outcome);
    if (transfer->receives && transfer->failed)
        *outcome = (struct mesh_outcome){.result = PS_ERROR_IO};
    move_meshes(transfer, fragment);
    move_structs(transfer, &fragment->objects, &fragment->object_count, sizeof *fragment->objects);
    move_materials(transfer, fragment);
    move_textures(transfer, fragment);
    move_cameras(transfer, fragment);
    move_structs(transfer, &fragment->lights, &fragment->light_count, sizeof *fragment->lights);
    move_looks(transfer, &outcome->looks);
}

bool mesh_outcome_send(struct mesh_outcome *outcome, int file)
{
    struct transfer transfer = {.file = file};
    move_outcome(&transfer, outcome);
    return !transfer.failed;
}

bool mesh_outcome_receive(struct mesh_outcome *outcome, int file)
{
    struct transfer transfer = {.file = file, .receives = true};
    move_outcome(&transfer, outcome);
    if (!transfer.failed)
        return true;
    mesh_outcome_release(outcome);
    return false;
}

void mesh_outcome_release(struct mesh_outcome *outcome)
{
    scene_description_release(&outcome->fragment);
    mesh_looks_release(&outcome->looks);
}
