/* hemisphere_mesh.h: how irradiance changes as the point moves, from the rays that found it.
 *
 * Schwarzhaupt, Jensen and Jarosz 2012, "Practical Hessian-based error control for irradiance
 * caching". What the rays of neighbouring strata met are the vertices of a mesh, which stands for
 * all that the point sees. Each triangle has one radiance, that of its farthest vertex: where an
 * object in front ends, the triangle that joins it to what is behind is seen edge-on, and shows
 * more of what is behind as the point moves. The polygon inside of the innermost ring has the mean
 * of its vertices, and beyond the outermost all goes on as it is there. By Lambert's formula
 *
 *     E = 1/2 sum over edges of (L_left - L_right) theta n.(r1 x r2) / |r1 x r2|
 *
 * with r1 and r2 the ends of an edge as seen from the point, and theta the angle between them. Its
 * derivatives are closed forms, and know of occlusion.
 */
#ifndef PSPLAT_ESTIMATOR_HEMISPHERE_MESH_H
#define PSPLAT_ESTIMATOR_HEMISPHERE_MESH_H

#include <psplat/plugin.h>

/* Rays over the hemisphere around z, in strata of equal projected solid angle: ring j holds those
 * whose sine of the angle to z is between sqrt(j / rings) and sqrt((j + 1) / rings); sectors are
 * equal parts of the circle. Ray j * sectors + k is that of ring j and sector k. */
struct hemisphere {
    uint32_t rings, sectors; /* at least 2 and 3 */
    const ps_vec3 *hits;     /* where the rays ended, as seen from the point, within 1e-6 to 1e6 */
    const ps_rgb *radiance;  /* what they found */
};

/* Derivatives by the position in the plane z = 0, in the units of the hits. */
struct hemisphere_derivatives {
    ps_rgb gradient_x, gradient_y; /* of irradiance */
    float xx, xy, yy;              /* second ones of its luminance */
};

struct hemisphere_derivatives hemisphere_derivatives(const struct hemisphere *hemisphere);

#endif
