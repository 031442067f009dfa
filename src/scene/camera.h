/* camera.h: rays from the camera through points of the picture.
 *
 * Perspective through a pinhole or a thin lens (Cook et al. 1984), or orthographic.
 */
#ifndef SCENE_CAMERA_H
#define SCENE_CAMERA_H

#include "scene/description.h"

struct camera {
    bool orthographic;
    ps_vec3 location;
    ps_vec3 forward;      /* unit */
    ps_vec3 corner;       /* from the location to the picture's upper left corner, at distance 1 */
    ps_vec3 across, down; /* the picture's width and height there, one pixel long */
    ps_vec3 lens_u, lens_v; /* the lens's radius along the picture's sides */
    float aperture;         /* the lens's radius; 0: none */
    float focus;            /* distance along `forward` at which things are sharp */
};

struct camera camera_from_description(const struct camera_description *description, size_t width,
                                      size_t height);

/* Ray through point (x, y) of the picture, in pixels from the upper left corner. `lens`: two
 * numbers in [0,1) that choose a point of the lens; without a lens they are not used. */
ps_ray camera_ray(const struct camera *camera, float x, float y, const float lens[2]);

/* The camera of a part of the picture, from (left, top) on, in pixels whose sides are `step` times
 * as long. */
struct camera camera_of_part(const struct camera *camera, float left, float top, float step);

/* Where in the picture, in pixels from the upper left corner, a point shows that is sharp; it may
 * lie outside of the picture. False behind the camera. */
bool camera_project(const struct camera *camera, ps_vec3 point, float *x, float *y);

/* By how much the cone through a pixel gets wider with the distance along a ray; 0 without
 * perspective. */
float camera_pixel_spread(const struct camera *camera, ps_vec3 direction);

/* How long one pixel's side is at a point before the camera; 0 behind it. */
float camera_pixel_size(const struct camera *camera, ps_vec3 point);

#endif
