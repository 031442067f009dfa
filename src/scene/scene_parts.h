/* scene_parts.h: the steps in which scene_create builds a scene; each leaves it releasable. */
#ifndef SCENE_SCENE_PARTS_H
#define SCENE_SCENE_PARTS_H

#include "scene/scene.h"

/* A scene under construction. */
struct assembly {
    const struct scene_description *description;
    struct scene *scene;
    struct origin where;      /* what the step is at, for errors */
    struct origin dropped_at; /* the first object that lost triangles */
    struct error *error;
};

/* Of a mesh's description, or of a shape. */
#define VERTEX_BYTES(mesh_)                                                                        \
    (sizeof *(mesh_)->vertices + ((mesh_)->normals ? sizeof *(mesh_)->normals : 0) +               \
     ((mesh_)->uv ? sizeof *(mesh_)->uv : 0) +                                                     \
     ((mesh_)->second_uv ? sizeof *(mesh_)->second_uv : 0) +                                       \
     ((mesh_)->colors ? sizeof *(mesh_)->colors : 0))

/* Zeroed room, at least for one element; NULL, reported, when out of memory. */
void *assembly_allocate(struct assembly *assembly, size_t count, size_t size);

/* Textures, materials (those of lights last), and what gloss needs. */
ps_result assembly_add_materials(struct assembly *assembly);

/* Shapes of the world, lights, groups; instances. Needs materials. */
ps_result assembly_add_geometry(struct assembly *assembly);

/* Lights, those of emissive objects last, and their shares. Needs all others and the bounds. */
ps_result assembly_add_lights(struct assembly *assembly);

/* Whether a light is a surface, which is a shape with a material of its own. */
bool light_is_lamp(const struct light_description *light);

/* A light as an object, whose arrays are the caller's to release (object_description_release).
 * False when out of memory. */
bool lamp_describe(const struct light_description *light, struct object_description *object);

#endif
