/* bin.h: which splats touch which tiles.
 *
 * A pyramid of bounds over the tiles (4x4 children a node; box of positions and box of normals) is
 * walked for each splat, and a counting sort gathers the pairs by tile, in splat order. Tiled
 * gathering with bins was the fastest of the methods that Mara et al. 2013, "Toward practical
 * real-time photon mapping", compared; and since one thread owns a tile, it needs no atomics and
 * the order of sums is fixed.
 */
#ifndef SPLAT_BIN_H
#define SPLAT_BIN_H

#include "base/error.h"
#include "film/gbuffer.h"

struct pyramid_node {
    ps_vec3 center, extent; /* box of positions; extent negative where the node sees no surface */
    ps_vec3 normal_low, normal_high;
};

#define PYRAMID_LEVELS 8
#define PYRAMID_GROUP 4 /* children of a node, across and down */

struct pyramid {
    struct pyramid_node *nodes; /* all levels, tiles first; owned */
    size_t first[PYRAMID_LEVELS];
    uint32_t across[PYRAMID_LEVELS], down[PYRAMID_LEVELS];
    int levels;
};

/* Room for the pyramid of a G-buffer of this size. */
ps_result pyramid_create(const struct gbuffer *gbuffer, struct pyramid *pyramid,
                         struct error *error);
void pyramid_release(struct pyramid *pyramid);

/* Bounds of what the tiles see now. */
void pyramid_build(struct pyramid *pyramid, const struct gbuffer *gbuffer, uint32_t threads);

/* Pairs of a batch of splats, sorted by tile: tile t has splats indices[offsets[t] .. offsets[t +
 * 1]). */
struct bins {
    uint32_t *offsets; /* tile_count + 1, owned */
    uint32_t *indices; /* owned */
    size_t capacity;   /* of indices */
    uint32_t tile_count;
    struct bin_chunk *chunks; /* scratch, owned */
};

ps_result bins_create(uint32_t tile_count, struct bins *bins, struct error *error);
void bins_release(struct bins *bins);
size_t bins_bytes(const struct bins *bins);

ps_result bins_sort(struct bins *bins, const struct pyramid *pyramid, const ps_splat *splats,
                    size_t n, uint32_t threads, struct error *error);

#endif
