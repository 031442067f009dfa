/* exact.h: the inner loop for visibilities that judge every point by itself.
 *
 * The same sums as kernel.h, with V(p) from the visibility's test of the point instead of a depth
 * map. The kernel weighs a tile's pixels as if nothing were in the way; those with weight are asked
 * for, all of a splat at once, since their rays run side by side.
 */
#ifndef SPLAT_EXACT_H
#define SPLAT_EXACT_H

#include "splat/kernel.h"
#include <psplat/strategy.h>

struct exact_test {
    const struct kernel_variant *kernel; /* weighs the points */
    const ps_visibility_vtable *vtable;  /* with `visible` */
    const void *state;
    const ps_host *host;
    float surface_offset; /* see ps_pass */
};

/* Adds n splats, in order, to the tile. `splats` and `prepared` are the same splats, chosen by
 * `indices`. Tests are of points with weight. Any thread that owns the tile. */
struct kernel_count exact_accumulate(struct interleaved_tile *tile, const struct exact_test *test,
                                     const struct splat *splats,
                                     const struct kernel_splat *prepared, const uint32_t *indices,
                                     size_t n, const struct kernel_profile *profile);

#endif
