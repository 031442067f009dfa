/* shape.h: turns a described object into a shape in world space. */
#ifndef SCENE_SHAPE_H
#define SCENE_SHAPE_H

#include "scene/scene.h"

ps_result shape_create(const struct object_description *object, struct shape *shape,
                       struct error *error);
void shape_release(struct shape *shape);

/* Grows the box [low, high] to hold the shape. */
void shape_extend_bounds(const struct shape *shape, ps_vec3 *low, ps_vec3 *high);

#endif
