/* volume.h: what cones look at: the scene in voxels, with coarser and coarser levels of them.
 *
 * Crassin et al. 2011. Each voxel knows, along each of the three axes, which share of it is covered
 * (opacity), and for each of six sides the mean radiance that a look along the axis at this side
 * finds in it; what looks through counts as black (premultiplied). A level has half as many voxels
 * along each axis as the one below. Two voxels behind each other are put together as layers, a
 * before b,
 *
 *     opacity = 1 - (1 - opacity_a) (1 - opacity_b)
 *     light   = light_a + (1 - opacity_a) light_b,
 *
 * and the four columns side by side by their mean: so a wall stays opaque, and its dark side dark,
 * however coarse the level is. A mean of all eight would make a wall of one voxel half transparent
 * at each level.
 *
 * Memory goes by surfaces: voxels that hold none are not there. The paper keeps an octree of
 * bricks. Here each level has bricks of 4x4x4 voxels, found by a table (one word for each place of
 * a brick) in place of a walk down the tree; in a brick a bit tells which voxels there are, and the
 * bits before it where (popcount).
 */
#ifndef PSPLAT_VOXEL_CONE_VOLUME_H
#define PSPLAT_VOXEL_CONE_VOLUME_H

#include "../shared/voxel_grid.h"

#define VOLUME_MEMORY "radiance voxels"
#define VOLUME_MOST_LEVELS 12

/* Sides: 0 to 2 face along axis x, y, z; 3 to 5 against it. */
static inline uint32_t volume_side(uint32_t axis, bool against)
{
    return against ? axis + 3 : axis;
}

/* How surfaces lie: the sum of n_k n_l over their area, in squares of a voxel's side (up to a
 * factor). */
struct voxel_tilt {
    float diagonal[3]; /* k = l: 0, 1, 2 */
    float mixed[3];    /* k and l: 0 and 1, 1 and 2, 2 and 0 */
};

struct voxel {
    float opacity[3]; /* along each axis, either way */
    float depth[3];   /* of the finest level: how far along each axis surfaces lie in it, 0..1 */
    struct voxel_tilt tilt;
    ps_rgb light[6]; /* W/(m^2 sr), by sides */
};

struct voxel_brick {
    uint64_t mask;  /* which voxels there are */
    uint32_t first; /* of its voxels */
    uint32_t x, y, z;
};

struct volume_level {
    uint32_t across;        /* voxels along each axis */
    uint32_t bricks_across; /* places of bricks */
    uint32_t *table;        /* of places: the brick there; 0 is one without voxels */
    struct voxel_brick *bricks;
    struct voxel *voxels;
    size_t brick_count, voxel_count;
};

struct volume {
    const ps_host *host;
    struct voxel_grid grid; /* of level 0 */
    uint32_t level_count;
    struct volume_level levels[VOLUME_MOST_LEVELS];
};

/* What surfaces in a voxel of the finest level look like along one axis. */
struct volume_part {
    uint32_t x, y, z, axis;
    float opacity, depth;
    struct voxel_tilt tilt; /* those of a voxel's parts are added up */
    ps_rgb light[2];        /* of the sides that face along the axis and against it */
};

/* Makes the finest level of n parts: voxels where there are any, at most one part for each voxel
 * and axis. Release the volume whatever it returns. */
ps_result volume_create(const ps_host *host, const struct voxel_grid *grid,
                        const struct volume_part *parts, size_t n, struct volume *volume);

/* Makes the coarser levels of the finest one. Main thread. */
ps_result volume_build_levels(struct volume *volume);

/* Adds light to the finest level, and brings the coarser ones up to date. `light` has six sides for
 * each voxel of a level, premultiplied by its opacity, as voxels have them; the voxels below share
 * it as far as they are covered. Main thread. */
void volume_add_light(struct volume *volume, uint32_t level, const ps_rgb (*light)[6]);

void volume_release(struct volume *volume);

static inline void voxel_tilt_add(struct voxel_tilt *sum, const struct voxel_tilt *tilt)
{
    for (int k = 0; k < 3; k++) {
        sum->diagonal[k] += tilt->diagonal[k];
        sum->mixed[k] += tilt->mixed[k];
    }
}

/* The bit of a voxel in its brick. */
static inline uint32_t volume_bit(uint32_t x, uint32_t y, uint32_t z)
{
    return (z & 3) << 4 | (y & 3) << 2 | (x & 3);
}

/* The place of that voxel in its level. */
static inline void volume_place(const struct voxel_brick *brick, uint32_t bit, uint32_t place[3])
{
    place[0] = 4 * brick->x + (bit & 3);
    place[1] = 4 * brick->y + (bit >> 2 & 3);
    place[2] = 4 * brick->z + (bit >> 4);
}

/* How many bits are set. */
static inline uint32_t volume_count_bits(uint64_t mask)
{
#ifdef __GNUC__
    return (uint32_t)__builtin_popcountll(mask);
#else
    uint32_t count = 0;
    for (; mask; mask &= mask - 1)
        count++;
    return count;
#endif
}

/* The entry of the table for the brick around (x, y, z). */
static inline uint32_t *volume_brick_at(const struct volume_level *level, uint32_t x, uint32_t y,
                                        uint32_t z)
{
    size_t row = (size_t)(z >> 2) * level->bricks_across + (y >> 2);
    return &level->table[row * level->bricks_across + (x >> 2)];
}

/* The voxel of a level at (x, y, z), or NULL where there is none. */
static inline struct voxel *volume_at(const struct volume_level *level, uint32_t x, uint32_t y,
                                      uint32_t z)
{
    if (x >= level->across || y >= level->across || z >= level->across)
        return NULL;
    const struct voxel_brick *brick = &level->bricks[*volume_brick_at(level, x, y, z)];
    uint32_t bit = volume_bit(x, y, z);
    if (!(brick->mask >> bit & 1))
        return NULL;
    uint64_t before = brick->mask & ((UINT64_C(1) << bit) - 1);
    return &level->voxels[brick->first + volume_count_bits(before)];
}

#endif
