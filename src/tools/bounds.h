/* bounds.h: tells how large a scene is and where it lies. */
#ifndef TOOLS_BOUNDS_H
#define TOOLS_BOUNDS_H

#include "scene/scene.h"

/* Prints to stdout, a line each: the box around the scene, those around its mesh files and around
 * instances that hold some, and the camera, as a scene would say it. The scene was made of the
 * description. */
ps_result bounds_print(const struct scene_description *description, const struct scene *scene,
                       struct error *error);

#endif
