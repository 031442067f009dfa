/* scene_box.h: the boxes around what a scene holds, in scene units. A box is empty (box_is_empty)
 * around nothing.
 *
 * The box of an instance is that around the corners of its group's box, which may be larger than
 * the group.
 */
#ifndef SCENE_SCENE_BOX_H
#define SCENE_SCENE_BOX_H

#include "scene/box.h"
#include "scene/scene.h"

/* Around shapes, in their own space. */
struct box scene_box_of_shapes(const struct scene *scene, size_t first, size_t count);

/* Calls back for each object of the description, in its order, with its box in the world. The scene
 * was made of the description. Planes inside of groups are not counted. */
void scene_each_box(const struct scene_description *description, const struct scene *scene,
                    void (*each)(void *user, const struct object_description *object,
                                 const struct box *box),
                    void *user);

/* Around all objects but planes without an extent. */
struct box scene_box(const struct scene_description *description, const struct scene *scene);

/* Around what is worth a look: objects that the camera sees, without planes and without floors,
 * which are quads and discs that nothing reaches below, level where `up` points upwards. Around
 * floors and planes too where there is nothing else. */
struct box scene_box_to_frame(const struct scene_description *description,
                              const struct scene *scene, ps_vec3 up);

#endif
