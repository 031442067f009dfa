/* camera_frame.h: where a camera stands, and how it looks, that is to show a box whole (`location:
 * auto`).
 *
 * It looks from the side that a model's front is usually on (+z where y is upwards), turned to the
 * right and raised: the three-quarter view.
 */
#ifndef SCENE_CAMERA_FRAME_H
#define SCENE_CAMERA_FRAME_H

#include "base/error.h"
#include "scene/box.h"
#include "scene/description.h"

/* The camera with all that it had to find: the whole box is in a picture of that shape, with a
 * margin, whatever the field of view. An empty box counts as one of a unit about the origin.
 * PS_ERROR_INVALID where what it was given leaves it no direction of view. */
ps_result camera_frame(struct camera_description *camera, const struct box *box, size_t width,
                       size_t height, struct error *error);

/* The same for a perspective camera that looks along -`away`, whatever it was given but for its up
 * and angles, which are not both 0; `away` is not along up. */
void camera_frame_from(struct camera_description *camera, const struct box *box, ps_vec3 away,
                       double aspect);

#endif
