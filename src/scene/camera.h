/* camera.h: a pinhole camera: rays through points of the picture. */
#ifndef SCENE_CAMERA_H
#define SCENE_CAMERA_H

#include "scene/description.h"

struct camera {
    ps_vec3 location;
    ps_vec3 corner;       /* from the location to the picture's upper left corner, at distance 1 */
    ps_vec3 across, down; /* the picture's width and height there, one pixel long */
};

struct camera camera_from_description(const struct camera_description *description, size_t width,
                                      size_t height);

/* Ray through point (x, y) of the picture, in pixels from the upper left corner. */
ps_ray camera_ray(const struct camera *camera, float x, float y);

#endif
