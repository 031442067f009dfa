#include "stratify/cells.h"

#include <math.h>

/* The index of a cell along an axis. What is no number counts as in the first. */
static uint64_t cell_index(float position, float origin, double side)
{
    double index = floor(((double)position - (double)origin) / side);
    return (uint64_t)fmin(fmax(index, 0.0), (double)(PS_CELLS_ACROSS - 1));
}

/* Moves bit i to bit 3i, for the lowest 21 bits. */
static uint64_t spread_bits(uint64_t x)
{
    x = (x | x << 32) & UINT64_C(0x001f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x001f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    x = (x | x << 2) & UINT64_C(0x1249249249249249);
    return x;
}

uint64_t cells_key(const ps_lattice *lattice, uint32_t layer, ps_vec3 position)
{
    uint64_t x = cell_index(position.x, lattice->origin.x, lattice->side);
    uint64_t y = cell_index(position.y, lattice->origin.y, lattice->side);
    uint64_t z = cell_index(position.z, lattice->origin.z, lattice->side);
    return (uint64_t)layer << 3 * PS_CELL_BITS | spread_bits(x) << 2 | spread_bits(y) << 1 |
           spread_bits(z);
}

ps_lattice cells_lattice(ps_vec3 corner, double side, ps_vec3 center, float radius)
{
    double x = floor(((double)center.x - radius - corner.x) / side);
    double y = floor(((double)center.y - radius - corner.y) / side);
    double z = floor(((double)center.z - radius - corner.z) / side);
    ps_vec3 origin = {(float)(corner.x + x * side), (float)(corner.y + y * side),
                      (float)(corner.z + z * side)};
    return (ps_lattice){origin, side};
}

static ps_lattice lattice_of_scene(const ps_host *host, ps_vec3 corner, double side)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    return cells_lattice(corner, side, center, radius);
}

static int32_t too_small(const ps_host *host, double side)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    return !(2.0 * (double)radius / side + 2.0 <= (double)PS_CELLS_ACROSS);
}

/* Moves entries to `sorted` by the digit of their keys at `shift`; 0, and nothing moved, where that
 * is the same in all. */
static int sort_digit(const ps_key_entry *entries, ps_key_entry *sorted, size_t n, unsigned shift)
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

/* Least significant digit first. */
static ps_key_entry *sort(ps_key_entry *entries, ps_key_entry *spare, size_t n)
{
    for (unsigned shift = 0; shift < 64; shift += 8)
        if (sort_digit(entries, spare, n, shift)) {
            ps_key_entry *sorted = spare;
            spare = entries;
            entries = sorted;
        }
    return entries;
}

const ps_cells cells_service = {
    .size = sizeof cells_service,
    .lattice = lattice_of_scene,
    .too_small = too_small,
    .key = cells_key,
    .sort = sort,
};
