/* bin.h: which splats touch which tiles.
 *
 * The pyramid is walked for each splat, and a counting sort gathers the pairs by tile, in splat
 * order. Tiled gathering with bins was the fastest of the methods that Mara et al. 2013, "Toward
 * practical real-time photon mapping", compared; and since one thread owns a tile, it needs no
 * atomics and the order of sums is fixed.
 */
#ifndef SPLAT_BIN_H
#define SPLAT_BIN_H

#include "base/parallel.h"
#include "splat/pyramid.h"

/* Pairs of a batch of splats, sorted by tile: tile t has splats indices[offsets[t] .. offsets[t +
 * 1]), for first_tile <= t < end_tile; other tiles have none. The range is that of the subsets that
 * the batch lights, which are few: light paths that follow each other share one. */
struct bins {
    uint32_t first_tile, end_tile;
    size_t lighting;   /* splats that light anything, in view or not */
    uint32_t *offsets; /* tile_count + 1, owned */
    uint32_t *indices; /* owned */
    size_t capacity;   /* of indices */
    uint32_t tile_count;
    struct bin_chunk *chunks; /* scratch, owned */
};

/* Empty bins of so many tiles. PS_ERROR_MEMORY: nothing is left to release. Main thread, as all
 * functions here. */
ps_result bins_create(uint32_t tile_count, struct bins *bins, struct error *error);
void bins_release(struct bins *bins);
size_t bins_bytes(const struct bins *bins);

/* Sorts n splats into the tiles that they may touch, in place of what the bins held; those whose
 * kernel_scale is 0 touch none. The order does not depend on `workers`. PS_ERROR_MEMORY, or
 * PS_ERROR_INVALID where there are more than 2^32 pairs. */
ps_result bins_sort(struct bins *bins, const struct pyramid *pyramid,
                    const struct kernel_variant *kernel, const struct kernel_splat *splats,
                    size_t n, struct workers *workers, struct error *error);

#endif
