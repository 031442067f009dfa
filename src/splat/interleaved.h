/* interleaved.h: what splats light: the G-buffer's surfaces and sums, arranged for the inner loop.
 *
 * Interleaved sampling (Segovia et al. 2006, "Non-interleaved deferred shading of interleaved
 * sample patterns", after Keller and Heidrich 2001): the pixels fall into n x n subsets, every n-th
 * across and down, and a splat lights those of one subset only, n^2 times as strongly. That costs
 * n^2 times fewer tests; as splats are far larger than n pixels, what neighbours learned from
 * different splats makes up for it when interleaved_join averages them.
 *
 * A tile holds 16x16 pixels of one subset, in blocks of 4x4 that lie one after the other and are
 * bounded by a box each: a block is what the inner loop takes at a time.
 */
#ifndef SPLAT_INTERLEAVED_H
#define SPLAT_INTERLEAVED_H

#include "base/parallel.h"
#include "film/gbuffer.h"
#include "splat/bounds.h"

#define INTERLEAVED_BLOCK 16 /* pixels of a block, lanes 16 b to 16 b + 15 of a tile */

/* Of a tile's surfaces themselves. */
struct geometric_normals {
    _Alignas(64) float x[PS_TILE_PIXELS];
    float y[PS_TILE_PIXELS], z[PS_TILE_PIXELS];
};

struct interleaved_tile {
    _Alignas(64) float position_x[PS_TILE_PIXELS];
    float position_y[PS_TILE_PIXELS], position_z[PS_TILE_PIXELS];
    float normal_x[PS_TILE_PIXELS], normal_y[PS_TILE_PIXELS], normal_z[PS_TILE_PIXELS];
    float irradiance_r[PS_TILE_PIXELS], irradiance_g[PS_TILE_PIXELS], irradiance_b[PS_TILE_PIXELS];
    float weight[PS_TILE_PIXELS];
    /* The interleaved pixels' own; NULL: the normals are those of the surfaces. */
    struct geometric_normals *geometric;
    struct bounds blocks;
};

struct interleaved {
    uint32_t interleave;               /* n */
    uint32_t subsets;                  /* n^2 */
    uint32_t tiles_across, tiles_down; /* of each subset */
    uint32_t tile_count;               /* of all subsets, one subset after the other */
    uint32_t left, top;                /* the window's first column and row */
    size_t width, height;              /* where its columns and rows end, counted in the picture */
    struct interleaved_tile *tiles;    /* owned */
    bool has_geometric_normals;
    struct geometric_normals *geometric_normals; /* of each tile, owned; or NULL */
};

/* Interleaved pixels of a G-buffer's window, and no memory for it; `interleave`
 * 1..PS_MOST_INTERLEAVE. */
struct interleaved interleaved_layout(const struct gbuffer *gbuffer, uint32_t interleave);

/* Memory for the tiles of a layout, which have to be filled. PS_ERROR_MEMORY: nothing is left to
 * release. */
ps_result interleaved_create(struct interleaved layout, struct interleaved *interleaved,
                             struct error *error);
void interleaved_release(struct interleaved *interleaved);
size_t interleaved_bytes(const struct interleaved *interleaved);

/* Column and row of a lane; false if it lies outside of the window. */
bool interleaved_pixel(const struct interleaved *interleaved, uint32_t tile, uint32_t lane,
                       uint32_t *x, uint32_t *y);

/* What a lane of a tile shows: a surface, or nothing. */
void interleaved_set_lane(struct interleaved_tile *tile, uint32_t lane, ps_vec3 position,
                          ps_vec3 normal);
void interleaved_clear_lane(struct interleaved_tile *tile, uint32_t lane);

/* Zeroes the sums of a tile whose lanes are set, and bounds its blocks. */
void interleaved_begin_tile(struct interleaved_tile *tile);

/* Takes the surfaces from the G-buffer and zeroes the sums. */
void interleaved_fill(struct interleaved *interleaved, const struct gbuffer *gbuffer,
                      struct workers *workers);

/* Gives each pixel of the G-buffer the mean of what the subsets learned around it, in `splatted`
 * where that is prepared: over a window of n pixels across and down, or n + 1 whose border weighs
 * half where n is even, so that each subset weighs the same inside of a surface; pixels off the
 * same plane do not count. */
void interleaved_join(const struct interleaved *interleaved, struct gbuffer *gbuffer,
                      struct workers *workers);

#endif
