/* splatter.h: adds the light of a batch of splats to the tiles: maps, bins, kernel; or, where the
 * visibility judges points by themselves, bins and the loop of exact.h.
 *
 * Memory is bounded: splats go through in batches whose depth maps fit a fixed budget. The result
 * does not depend on the batches nor on the threads: every pixel adds its splats in their order.
 */
#ifndef SPLAT_SPLATTER_H
#define SPLAT_SPLATTER_H

#include "film/gbuffer.h"
#include "splat/bin.h"
#include "splat/kernel.h"
#include <psplat/strategy.h>

struct splatter_visibility {
    const ps_visibility_vtable *vtable;
    const void *state;
    float surface_offset; /* see ps_pass */
};

struct splatter {
    struct gbuffer *gbuffer;
    const ps_host *host;
    struct splatter_visibility visibility;
    struct kernel_profile profile;
    kernel_function accumulate;
    uint32_t resolution; /* of depth maps; 0: none */
    uint32_t threads;
    size_t batch; /* splats at a time */
    struct pyramid pyramid;
    struct bins bins;
    float *depths;                 /* batch * resolution^2 */
    struct kernel_splat *prepared; /* batch */
    /* Statistics, summed over all calls. */
    double map_seconds, bin_seconds, kernel_seconds;
    uint64_t tests, useful_tests, map_rays, exact_tests, splats;
};

/* `batch`: at most so many splats at a time; the budget for depth maps may ask for fewer. */
ps_result splatter_create(struct splatter *splatter, struct gbuffer *gbuffer, const ps_host *host,
                          struct splatter_visibility visibility,
                          const struct kernel_profile *profile, kernel_function accumulate,
                          uint32_t threads, size_t batch, struct error *error);
void splatter_release(struct splatter *splatter);
size_t splatter_bytes(const struct splatter *splatter);

/* To be called when the G-buffer was filled anew. */
void splatter_begin_pass(struct splatter *splatter);

/* Adds n splats; cuts their depth ranges to their maps. */
ps_result splatter_add(struct splatter *splatter, ps_splat *splats, size_t n, struct error *error);

#endif
