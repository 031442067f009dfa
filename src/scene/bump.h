/* bump.h: shading normals bent as if the surface were bumpy.
 *
 * Bumps: Blinn 1978, "Simulation of wrinkled surfaces": of a surface raised by a height h along its
 * normal n, the normal is that of n - grad h, grad h being the height's gradient along the surface.
 * For an image it comes from the derivatives along u and v, for a procedural pattern from those in
 * space (Mikkelsen 2010, "Bump mapping unparametrized surfaces on the GPU", has both in this form,
 * which needs no handedness of (u, v)).
 *
 * Heights are scene units, and rise to the side that `normal` is on: a caller who flips normals to
 * the side of the viewer, and wants hills to be dales seen from behind, bends the front's normal
 * and flips the result. Point, normal and derivatives are in the space of the pigment's points.
 * Results are of length 1 and on the side of `normal`, which they equal where nothing sensible can
 * be said. Pure functions.
 */
#ifndef SCENE_BUMP_H
#define SCENE_BUMP_H

#include "scene/pigment.h"

/* log_width: as of pigment_filter, and of texture_filter. `normal` has length 1; `dpdu`, `dpdv` are
 * derivatives of the position by u and v, or 0 where the surface has no (u, v): then images have no
 * effect. */
ps_vec3 bump_bump(const struct pigment *height, ps_vec3 point, const float uv[2], float log_width,
                  ps_vec3 normal, ps_vec3 dpdu, ps_vec3 dpdv);

/* A map of normals in the surface's own frame: red along u, green along v (upwards, as OpenGL and
 * glTF have it), blue along the normal. It holds (n + 1) / 2; in 8-bit maps the middle is 128, the
 * value that makers of maps store for "flat", with 255 for 1. It must be loaded with
 * ENCODING_LINEAR. The frame is made orthonormal, u first: tilts do not depend on the picture's
 * stretch. (u, v) are the picture's own: whoever scales them does so first. */
ps_vec3 bump_normal_map(const struct texture *map, const float uv[2], float log_width,
                        ps_vec3 normal, ps_vec3 dpdu, ps_vec3 dpdv);

#endif
