/* triangles.h: the scene as triangles in world space, in batches, for plugins.
 *
 * Instances come one by one. A sphere comes as PS_SPHERE_TRIANGLES, of rings around its poles, a
 * little outside of it, so that their area is the sphere's.
 */
#ifndef SCENE_TRIANGLES_H
#define SCENE_TRIANGLES_H

#include "scene/scene.h"
#include <psplat/host.h>

uint64_t triangles_count(const struct scene *scene);

/* Triangles `first` and on, at most n; returns how many. The order is that of objects. */
size_t triangles_get(const struct scene *scene, uint64_t first, size_t n, ps_triangle *triangles);

/* How many triangles a shape is given as. */
uint64_t triangles_of_shape(const struct shape *shape);

/* The direction from the centre of a sphere to a point of one of its triangles; `weights`: of the
 * second and third corner. Its length is about 1. */
ps_vec3 triangles_on_sphere(uint32_t triangle, const float weights[2]);

#endif
