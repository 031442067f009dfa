/* pyramid.h: bounds over the tiles of a interleaved.
 *
 * For each subset a tree of nodes that hold the bounds of 4x4 children: tiles on the first level,
 * nodes of the level below on the others. A splat walks down from the top, sixteen boxes at a time.
 */
#ifndef SPLAT_PYRAMID_H
#define SPLAT_PYRAMID_H

#include "base/parallel.h"
#include "splat/interleaved.h"
#include "splat/kernel.h"

#define PYRAMID_LEVELS 8
#define PYRAMID_GROUP 4 /* children of a node, across and down */

struct pyramid {
    struct bounds *nodes; /* of one subset after the other, all levels of each; owned */
    size_t each;          /* nodes of one subset */
    uint32_t subsets;
    size_t first[PYRAMID_LEVELS]; /* of each level, among a subset's nodes */
    uint32_t across[PYRAMID_LEVELS], down[PYRAMID_LEVELS];
    int levels;
    uint32_t tiles_across, tiles_down; /* of each subset */
};

/* Room for the pyramid of a interleaved, which has to be built before it is visited.
 * PS_ERROR_MEMORY: nothing is left to release. Main thread. */
ps_result pyramid_create(const struct interleaved *interleaved, struct pyramid *pyramid,
                         struct error *error);
void pyramid_release(struct pyramid *pyramid);
size_t pyramid_bytes(const struct pyramid *pyramid);

/* Bounds of what the tiles of `interleaved`, the one that it was created for, see now. Main thread;
 * works on `workers`. */
void pyramid_build(struct pyramid *pyramid, const struct interleaved *interleaved,
                   struct workers *workers);

/* Called with each tile that a splat may touch; returns whether to go on. */
typedef bool (*pyramid_visitor)(void *user, uint32_t tile);

/* Visits the tiles of the splat's subset that its box may touch, in an order that depends on the
 * interleaved pixels alone. False if the visitor stopped it. Any thread. */
bool pyramid_visit(const struct pyramid *pyramid, const struct kernel_variant *kernel,
                   const struct kernel_splat *splat, pyramid_visitor visitor, void *user);

#endif
