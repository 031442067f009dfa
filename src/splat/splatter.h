/* splatter.h: adds the light of a batch of splats to tiles, of pixels or of other points: maps,
 * bins, kernel; or, where the visibility judges points by themselves, bins and the loop of exact.h.
 *
 * Memory is bounded: splats go through in batches whose depth maps fit a fixed budget. The result
 * does not depend on the batches nor on the threads: every pixel adds its splats in their order.
 */
#ifndef SPLAT_SPLATTER_H
#define SPLAT_SPLATTER_H

#include "base/parallel.h"
#include "film/gbuffer.h"
#include "splat/bin.h"
#include "splat/kernel.h"
#include <psplat/strategy.h>
#include <stdatomic.h>

struct splatter_settings {
    const ps_host *host;
    const ps_visibility_vtable *visibility;
    const void *visibility_state;
    uint32_t resolution;  /* of its depth maps */
    float surface_offset; /* see ps_pass */
    struct kernel_profile profile;
    struct kernel_variant kernel;
    struct workers *workers;
    /* At most so many splats at a time; the budget for depth maps may ask for fewer. */
    size_t batch;
};

/* How many light paths a pass has: they share the subsets of pixels out. */
struct splatter_pass {
    uint32_t number;
    uint64_t path_count;
};

/* Whether it pays to ask which splats light nothing of the pass before they are made
 * (host/photons.c). */
struct unseen {
    uint64_t batches; /* placed so far in the pass */
    bool asked;       /* in this batch */
    bool many;        /* of those that were last asked */
    _Atomic(uint64_t) in_batch;
};

struct splatter {
    struct splatter_settings settings;
    uint32_t resolution; /* of depth maps; 0: none */
    struct splatter_pass pass;
    struct interleaved lit;
    struct pyramid pyramid;
    struct bins bins;
    struct unseen unseen;
    float *depths;                 /* batch * resolution^2 */
    struct kernel_splat *prepared; /* batch */
    /* Statistics, summed over all calls. */
    double map_seconds, bin_seconds, kernel_seconds, join_seconds;
    uint64_t tests, useful_tests, map_rays, exact_tests, splats;
};

/* `layout`: of what is lit, pixels of a G-buffer (interleaved.h) or points (point_tiles.h). */
ps_result splatter_create(struct splatter *splatter, struct interleaved layout,
                          const struct splatter_settings *settings, struct error *error);
void splatter_release(struct splatter *splatter);
size_t splatter_bytes(const struct splatter *splatter);

/* Begins a pass; `lit` has been filled with what it shows. */
void splatter_begin_pass(struct splatter *splatter, struct splatter_pass pass);

/* Whether a splat of this pass may light anything. Any thread. */
bool splatter_touches(const struct splatter *splatter, const struct splat *splat);

/* Adds n splats; cuts their depth ranges to their maps. */
ps_result splatter_add(struct splatter *splatter, struct splat *splats, size_t n,
                       struct error *error);

/* Adds what the pass's splats gave to the tiles of the G-buffer whose pixels they lit. */
void splatter_end_pass(struct splatter *splatter, struct gbuffer *gbuffer);

#endif
