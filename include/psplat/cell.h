/* cell.h: photons in the order of the cells of space that they lie in, for stratifications.
 *
 * A cell is a cube of a lattice, and its key the Morton code of its three indices (Morton 1966): the
 * 8^k cells of a cube of 2^k cells a side share all but the last 3k bits. So sorted by key, the
 * photons of a cell, of a block of cells, and of an octree's node are runs, and memory goes by
 * photons; an array of all cells would grow with the cube of their number along an axis.
 */
#ifndef PSPLAT_CELL_H
#define PSPLAT_CELL_H

#include <math.h>
#include <psplat/types.h>

/* Of a cell's index along an axis. The four bits above the Morton code are for layers: lattices that
 * are apart. */
#define PS_CELL_BITS 20
#define PS_CELLS_ACROSS (1u << PS_CELL_BITS)
#define PS_CELL_LAYERS 16

/* Cubic cells; those of index 0 begin at `origin`. Scene units. */
typedef struct ps_lattice {
    ps_vec3 origin;
    double side; /* of a cell, > 0 */
} ps_lattice;

/* A photon, by its index, and the cell that it lies in. */
typedef struct ps_cell_entry {
    uint64_t key;
    uint64_t index;
} ps_cell_entry;

/* The index of a cell along an axis. Positions past the lattice's first and last cells count as in
 * them, and so does what is no number. */
static inline uint64_t ps_cell_index(float position, float origin, double side)
{
    double index = floor(((double)position - (double)origin) / side);
    return (uint64_t)fmin(fmax(index, 0.0), (double)(PS_CELLS_ACROSS - 1));
}

/* Moves bit i to bit 3i, for the lowest 21 bits. */
static inline uint64_t ps_spread_bits(uint64_t x)
{
    x = (x | x << 32) & UINT64_C(0x001f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x001f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    x = (x | x << 2) & UINT64_C(0x1249249249249249);
    return x;
}

/* The key of the cell that a position lies in; layer < PS_CELL_LAYERS. */
static inline uint64_t ps_cell_key(const ps_lattice *lattice, uint32_t layer, ps_vec3 position)
{
    uint64_t x = ps_cell_index(position.x, lattice->origin.x, lattice->side);
    uint64_t y = ps_cell_index(position.y, lattice->origin.y, lattice->side);
    uint64_t z = ps_cell_index(position.z, lattice->origin.z, lattice->side);
    return (uint64_t)layer << 3 * PS_CELL_BITS | ps_spread_bits(x) << 2 | ps_spread_bits(y) << 1 |
           ps_spread_bits(z);
}

/* Non-zero where a lattice of such cells can't hold a scene of this radius. */
static inline int ps_cells_too_small(double side, float radius)
{
    return !(2.0 * (double)radius / side + 2.0 <= (double)PS_CELLS_ACROSS);
}

/* The lattice of such cells that has a corner of cells at `corner`, and holds the sphere. */
static inline ps_lattice ps_lattice_over(ps_vec3 corner, double side, ps_vec3 center, float radius)
{
    double x = floor(((double)center.x - radius - corner.x) / side);
    double y = floor(((double)center.y - radius - corner.y) / side);
    double z = floor(((double)center.z - radius - corner.z) / side);
    ps_vec3 origin = {(float)(corner.x + x * side), (float)(corner.y + y * side),
                      (float)(corner.z + z * side)};
    return (ps_lattice){origin, side};
}

/* Moves entries to `sorted` by the digit of their keys at `shift`; 0, and nothing moved, where that
 * is the same in all. */
static inline int ps_sort_digit(const ps_cell_entry *entries, ps_cell_entry *sorted, size_t n,
                                unsigned shift)
{
    size_t counts[256] = {0}, place = 0;
    for (size_t i = 0; i < n; i++)
        counts[entries[i].key >> shift & 255]++;
    if (n == 0 || counts[entries[0].key >> shift & 255] == n)
        return 0;
    for (int digit = 0; digit < 256; digit++) {
        size_t count = counts[digit];
        counts[digit] = place;
        place += count;
    }
    for (size_t i = 0; i < n; i++)
        sorted[counts[entries[i].key >> shift & 255]++] = entries[i];
    return 1;
}

/* Sorts by key; equal keys stay in their order (least significant digit first). `spare` has room for
 * n entries too; returns the one of the two arrays that holds the result. */
static inline ps_cell_entry *ps_sort_cells(ps_cell_entry *entries, ps_cell_entry *spare, size_t n)
{
    for (unsigned shift = 0; shift < 64; shift += 8)
        if (ps_sort_digit(entries, spare, n, shift)) {
            ps_cell_entry *sorted = spare;
            spare = entries;
            entries = sorted;
        }
    return entries;
}

#endif
