/* shape.h: turns a described object into a shape in the space of its file or group: triangles, or a
 * sphere.
 */
#ifndef SCENE_SHAPE_H
#define SCENE_SHAPE_H

#include "base/error.h"
#include "scene/description.h"

enum shape_kind { SHAPE_MESH, SHAPE_SPHERE };

struct shape {
    enum shape_kind kind;
    uint32_t material;
    bool hidden;       /* from the camera */
    ps_vec3 *vertices; /* mesh; counter-clockwise triangles seen from the front */
    ps_vec3 *normals;  /* mesh: unit, of each vertex, on the front; NULL: flat */
    float (*uv)[2];    /* mesh: of each vertex; NULL: none */
    size_t vertex_count;
    uint32_t (*triangles)[3]; /* mesh */
    size_t triangle_count;
    ps_vec3 center;  /* sphere */
    float radius;    /* sphere */
    ps_vec3 axes[3]; /* sphere: unit; where its own x, y, z point: u goes round axes[1] */
};

ps_result shape_create(const struct object_description *object, struct shape *shape,
                       struct error *error);
void shape_release(struct shape *shape);

/* Grows the box [low, high] to hold the shape. */
void shape_extend_bounds(const struct shape *shape, ps_vec3 *low, ps_vec3 *high);

#endif
