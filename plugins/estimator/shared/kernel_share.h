/* kernel_share.h: how much of a photon estimate's kernel lies on the surface.
 *
 * An estimate divides by the area of its disc. Near walls and edges part of the disc holds no
 * photons, because there is no surface: the estimate is too dark there (boundary bias; Jensen 2001,
 * section 7.3). Points of the disc, spread as the kernel weighs them, tell the share that is there:
 * a ray along the surface reaches the point, and one from above it finds the surface.
 */
#ifndef PSPLAT_ESTIMATOR_KERNEL_SHARE_H
#define PSPLAT_ESTIMATOR_KERNEL_SHARE_H

#include <psplat/plugin.h>

/* The share, in (0, 1], of a cone kernel of radius `radii[i]` at each of at most PS_TILE_PIXELS
 * points. `key` chooses how the points of the discs are turned. */
void kernel_shares(const ps_host *host, const ps_vec3 *positions, const ps_vec3 *normals,
                   const float *radii, size_t n, uint64_t key, float *shares);

#endif
