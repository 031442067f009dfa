/* camera.h: the camera as the last vertex of light paths.
 *
 * A camera draws a pixel's point x evenly over a square of the picture of area F: with density
 *
 *     p(x) = cos(theta) / (d^2 cos^3(theta_camera) F),   F measured at distance 1 from a pinhole
 *     p(x) = cos(theta) / F                                   from an orthographic camera
 *
 * by area of x's surface; theta is at the surface. The flux Phi that light tracing brings to x
 * counts as irradiance Phi p(x), a mean over what the pixel shows. Behind a lens, mirrors and glass
 * no connection to the camera lands where the camera would draw x, and p is 0.
 *
 * The square is as large as a pixel, and has the point that the pixel shows in this pass in its
 * middle. Where it shows mirrors, glass or nothing beside the surface, light lands on a share of it
 * alone: dividing by this share keeps the mean.
 */
#ifndef PSPLAT_ESTIMATOR_CAMERA_H
#define PSPLAT_ESTIMATOR_CAMERA_H

#include "subpath.h"

/* The ray from a point, which is moved off its surface, to the camera; returns p, or 0 where the
 * camera is not in front of the surface. */
float camera_ray_to(const struct bdpt *bdpt, ps_vec3 position, ps_vec3 geometric_normal,
                    ps_ray *ray);

/* Fills in the tile's sights but for the shares. Any thread. */
void camera_find_sights(const struct bdpt *bdpt, uint32_t tile);

/* After the sights of all tiles. */
void camera_find_jitter(struct bdpt *bdpt);

/* After the jitter. Any thread. */
void camera_find_shares(const struct bdpt *bdpt, uint32_t tile);

/* The pixel in whose square a place of the picture lies; 0 if none. */
int camera_pixel_at(const struct bdpt *bdpt, const float place[2], uint32_t *tile, uint32_t *lane);

#endif
