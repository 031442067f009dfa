/* cones.h: cones from a point, through the volume.
 *
 * Crassin et al. 2011. The irradiance is pi times the mean of the radiances that n cones see. The
 * cones' axes are the midpoints of n equal parts of the unit disc (a spiral by the golden angle,
 * Vogel 1979), raised to the hemisphere: so each has the same share of the cosine, 1 / n, and the
 * solid angle pi / (n cos(theta)) (Nusselt's analogue).
 *
 * A cone passes layers of voxels across each of the three axes, one after the other, and layers as
 * thick as it is wide there. Where it passes the middle of a layer across axis k it meets the share
 * c_k that the voxels around cover along this axis, interpolated inside of the layer (bilinearly).
 * A surface with normal n at a slope lies in several layers, whose shares exclude each other: along
 * the cone they add up to
 *
 *     sum over k of |n_k d_k| / |n.d| >= 1.
 *
 * So the shares of layers that follow each other are added until they are 1, and only behind a gap
 * multiply with what was left. The paper takes samples of all three axes together at steps along
 * the cone, and multiplies: that lets a fifth to a half of the light through a closed wall, the
 * more the more it slopes.
 *
 * Voxels that reach down to the receiver's own plane are left out of the interpolation, and those
 * above stand for them; and no layer is thicker than the cone is above that plane. Else cones at a
 * slope are stopped by the surface that they leave, or pass through all others. The paper starts at
 * a distance.
 */
#ifndef PSPLAT_VOXEL_CONE_CONES_H
#define PSPLAT_VOXEL_CONE_CONES_H

#include "volume.h"

#define CONES_MOST 1024

/* A cone around the normal (0, 0, 1). */
struct cone {
    ps_vec3 axis;
    float spread; /* thickness of the layers that it looks at, over the distance */
};

/* The n cones of a hemisphere. */
void cones_make(uint32_t n, struct cone *cones);

/* Radiance, W/(m^2 sr), that a cone finds from a point of a surface with that normal, in a
 * direction. */
ps_rgb cone_trace(const struct volume *volume, float spread, ps_vec3 position, ps_vec3 normal,
                  ps_vec3 direction);

/* Irradiance, W/m^2, by n cones that are turned around the normal by an angle (rad). */
ps_rgb cones_irradiance(const struct volume *volume, const struct cone *cones, uint32_t n,
                        ps_vec3 position, ps_vec3 normal, float turn);

#endif
