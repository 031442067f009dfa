/* cells.h: cubic cells of space, and sorting by them: an optional service.
 *
 * A cell is a cube of a lattice, and its key the Morton code of its three indices (Morton 1966):
 * the 8^k cells of a cube of 2^k cells a side share all but the last 3k bits. So sorted by key,
 * what lies in a cell, in a block of cells, or in an octree's node is a run, and memory goes by
 * what there is; an array of all cells would grow with the cube of their number along an axis.
 */
#ifndef PSPLAT_CELLS_H
#define PSPLAT_CELLS_H

#include <psplat/strategy.h>

#define PS_CELLS_EXTENSION "psplat.cells/1"

/* Of a cell's index along an axis. The four bits above the Morton code are for layers: lattices
 * that are apart. */
#define PS_CELL_BITS 20
#define PS_CELLS_ACROSS (1u << PS_CELL_BITS)
#define PS_CELL_LAYERS 16

/* Cubic cells; those of index 0 begin at `origin`. Scene units. */
typedef struct ps_lattice {
    ps_vec3 origin;
    double side; /* of a cell, > 0 */
} ps_lattice;

/* What host->extension gives for the name; pure functions. [any thread] */
typedef struct ps_cells {
    uint32_t size;
    uint32_t reserved;
    /* The lattice of such cells that has a corner of cells at `corner`, and holds the scene. */
    ps_lattice (*lattice)(const ps_host *host, ps_vec3 corner, double side);
    /* Non-zero where a lattice of such cells can't hold the scene. */
    int32_t (*too_small)(const ps_host *host, double side);
    /* The key of the cell that a position lies in; layer < PS_CELL_LAYERS. Positions past the
     * lattice's first and last cells count as in them. */
    uint64_t (*key)(const ps_lattice *lattice, uint32_t layer, ps_vec3 position);
    /* Sorts by key; equal keys stay in their order. `spare` has room for n entries too; returns the
     * one of the two arrays that holds the result. */
    ps_key_entry *(*sort)(ps_key_entry *entries, ps_key_entry *spare, size_t n);
} ps_cells;

#endif
