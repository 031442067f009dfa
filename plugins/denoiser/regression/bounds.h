/* bounds.h: bounds of what a few pixels of a row show, by which fits pass over pixels that are
 * unlike their centre.
 *
 * Where things are small, most pixels of a window have no weight. Bounds of the positions, normals
 * and shares of gloss of a run of pixels (fit.h) tell that for all at once: n . x lies in n . c +-
 * |n| . e for all points x of a box of centre c and half extents e.
 */
#ifndef PSPLAT_DENOISER_REGRESSION_BOUNDS_H
#define PSPLAT_DENOISER_REGRESSION_BOUNDS_H

#include <psplat/plugin.h>

struct regression;

/* Of a run. Centres and half extents; 0 where no surface is seen: the cosine of such normals with
 * any other is 0, so they have no weight (bend_scale >= 1). */
struct regression_bounds {
    float normal[3], normal_extent[3];
    float position[3], position_extent[3];
    float gloss, gloss_extent;
};

#define REGRESSION_BOUNDS_PIXEL 4 /* bytes of them for each pixel of a plane, at most */
size_t regression_bounds_bytes(size_t width, size_t height);

/* Fills regression->bounds in from its other planes. Runs on all workers. */
void regression_bounds_find(const struct regression *regression);

#endif
