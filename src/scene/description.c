/* description.c: frees a scene description, also one that was filled in part. */
#include "scene/description.h"

#include <stdlib.h>

void object_description_release(struct object_description *object)
{
    free(object->vertices);
    free(object->triangles);
}

static void release_objects(struct object_description *objects, size_t count)
{
    for (size_t i = 0; i < count; i++)
        object_description_release(&objects[i]);
    free(objects);
}

static void release_materials(struct scene_description *description)
{
    for (size_t i = 0; i < description->material_count; i++) {
        free(description->materials[i].name);
        free(description->materials[i].components);
        free(description->materials[i].weights);
    }
    free(description->materials);
}

static void release_textures(struct scene_description *description)
{
    for (size_t i = 0; i < description->texture_count; i++) {
        free(description->textures[i].path);
        free(description->textures[i].layer);
        free(description->textures[i].bytes);
    }
    free(description->textures);
}

static void release_geometry(struct scene_description *description)
{
    for (size_t i = 0; i < description->mesh_count; i++) {
        free(description->meshes[i].vertices);
        free(description->meshes[i].normals);
        free(description->meshes[i].uv);
        free(description->meshes[i].second_uv);
        free(description->meshes[i].colors);
        free(description->meshes[i].triangles);
    }
    free(description->meshes);
    for (size_t i = 0; i < description->group_count; i++) {
        free(description->groups[i].name);
        release_objects(description->groups[i].objects, description->groups[i].object_count);
    }
    free(description->groups);
    release_objects(description->objects, description->object_count);
}

void scene_description_release(struct scene_description *description)
{
    for (size_t i = 0; i < description->camera_count; i++)
        free(description->cameras[i].name);
    free(description->cameras);
    release_textures(description);
    release_materials(description);
    free(description->lights);
    release_geometry(description);
    render_description_release(&description->render);
    for (size_t i = 0; i < description->file_count; i++)
        free(description->files[i]);
    free(description->files);
    free(description->path);
    free(description->folder);
    free(description->cache);
    *description = (struct scene_description){0};
}
