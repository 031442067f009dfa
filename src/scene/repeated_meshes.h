/* repeated_meshes.h: a mesh that stands in many places costs its triangles once, and a placement
 * for each. */
#ifndef SCENE_REPEATED_MESHES_H
#define SCENE_REPEATED_MESHES_H

#include "scene/description.h"

/* Of one mesh: copies of so many triangles in all stay copies. Rays meet them somewhat sooner than
 * instances. */
#define REPEATED_TRIANGLES ((size_t)1 << 18)

/* Meshes whose copies have more triangles become groups of one object, and objects of them
 * instances, where the picture stays the same. False: out of memory; the description is whole in
 * any case. */
bool scene_description_share_meshes(struct scene_description *description);

#endif
