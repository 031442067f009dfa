/* triangles.h: the scene as triangles in world space, in batches, for plugins.
 *
 * Instances come one by one. A sphere comes as PS_SPHERE_TRIANGLES, of rings around its poles, a little outside of
 * it, so that their area is the sphere's.
 */
#ifndef SCENE_TRIANGLES_H
#define SCENE_TRIANGLES_H

#include "scene/scene.h"
#include <psplat/host.h>

uint64_t triangles_count(const struct scene *scene);

/* Triangles `first` and on, at most n; returns how many. The order is that of objects. */
size_t triangles_get(const struct scene *scene, uint64_t first, size_t n, ps_triangle *triangles);

#endif
