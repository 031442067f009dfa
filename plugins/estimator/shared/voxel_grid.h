/* voxel_grid.h: a cube of cubic cells.
 *
 * Places are in cells: cell (i, j, k) holds the places from (i, j, k) up to (i + 1, j + 1, k + 1).
 */
#ifndef PSPLAT_ESTIMATOR_VOXEL_GRID_H
#define PSPLAT_ESTIMATOR_VOXEL_GRID_H

#include <psplat/plugin.h>
#include <stdbool.h>

struct voxel_grid {
    ps_vec3 corner;  /* of cell (0, 0, 0) */
    float side;      /* of a cell, in scene units, > 0 */
    uint32_t across; /* cells along each axis */
};

static inline void voxel_components(ps_vec3 v, float components[3])
{
    components[0] = v.x;
    components[1] = v.y;
    components[2] = v.z;
}

/* A grid around the sphere of that centre and radius. `shift`, 0..1 along each axis, moves it by a
 * part of a cell: what surfaces at the borders of cells make of a grid differs with it. */
static inline struct voxel_grid voxel_grid_around(ps_vec3 center, float radius, uint32_t across,
                                                  const float shift[3])
{
    float reach = 1.001f * radius; /* what touches the sphere is inside */
    float side = 2.0f * reach / (float)(across - 1);
    ps_vec3 corner = {
        center.x - reach - shift[0] * side,
        center.y - reach - shift[1] * side,
        center.z - reach - shift[2] * side,
    };
    return (struct voxel_grid){corner, side, across};
}

static inline void voxel_grid_place(const struct voxel_grid *grid, ps_vec3 position, float place[3])
{
    voxel_components(ps_scale(ps_subtract(position, grid->corner), 1.0f / grid->side), place);
}

/* The cell that a position lies in; false where it lies outside. */
static inline bool voxel_grid_cell(const struct voxel_grid *grid, ps_vec3 position,
                                   uint32_t cell[3])
{
    float place[3];
    voxel_grid_place(grid, position, place);
    for (int axis = 0; axis < 3; axis++) {
        if (!(place[axis] >= 0.0f && place[axis] < (float)grid->across))
            return false;
        cell[axis] = (uint32_t)place[axis];
    }
    return true;
}

/* Where a value lies between those of two neighbours along an axis, which are known in the middles
 * of cells: the first of the two, -1 at least, and the share of the second. */
static inline int voxel_between(float place, float *share)
{
    float below = floorf(place - 0.5f);
    *share = place - 0.5f - below;
    return (int)below;
}

#endif
