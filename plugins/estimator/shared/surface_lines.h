/* surface_lines.h: lines through a grid of voxels that find all surfaces in it.
 *
 * A plugin that voxelizes need not know what a scene consists of: lines along the three axes,
 * `per_cell` times `per_cell` through each cell and both ways, are traced through everything that
 * they meet. So meshes, spheres and height fields are all found, with their textures and holes,
 * from the side that they are seen from.
 *
 * A unit of area with normal n is met by |n_k| / step^2 of the lines along axis k, one way (Cauchy
 * and Crofton). What share of a cell's lines along an axis meets something is therefore how much of
 * it is covered, seen along this axis; and as an estimate of area, the crossings of all three axes
 * weighed by the balance heuristic (Veach and Guibas 1995), each crossing stands for
 *
 *     step^2 / (|n_x| + |n_y| + |n_z|).
 *
 * Surfaces thinner than `step` are met by some of their lines, and those at a slope by fewer: in
 * the mean over shifts of the grid both are right.
 */
#ifndef PSPLAT_ESTIMATOR_SURFACE_LINES_H
#define PSPLAT_ESTIMATOR_SURFACE_LINES_H

#include "voxel_grid.h"

/* Ways: along axis 0, 1, 2, then against axis 0, 1, 2. The side of a surface that lines of a way
 * see has the number of the other way of its axis: lines along x see what faces against x. */
#define SURFACE_WAYS 6u

static inline uint32_t surface_axis(uint32_t way)
{
    return way % 3;
}

struct surface_lines {
    const ps_host *host;
    struct voxel_grid grid;
    uint32_t per_cell; /* lines across a cell */
    float offset;      /* how far behind a surface a line goes on; ps_pass.surface_offset */
};

/* Lines of one row that met something: each its next surface. */
struct surface_crossings {
    uint32_t way, row;
    uint32_t round; /* how many surfaces these lines met before */
    size_t n;
    uint32_t columns[PS_PATH_CHUNK];
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
};

typedef void (*surface_lines_take)(void *user, struct surface_crossings *crossings);

/* Rows of each way, and columns of each row. */
static inline uint32_t surface_lines_across(const struct surface_lines *lines)
{
    return lines->grid.across * lines->per_cell;
}

/* Follows all lines of a row and hands on what they meet inside of the grid, for each line in the
 * order of distance, and up to PS_PATH_CHUNK lines at a time. Column c passes through cells c /
 * per_cell along axis (way + 1) % 3; the row likewise along axis (way + 2) % 3. The taker may
 * change the hits. Any thread. */
void surface_lines_follow(const struct surface_lines *lines, uint32_t way, uint32_t row,
                          surface_lines_take take, void *user);

/* The area that a crossing stands for, in squares of the distance between lines, all lines of a way
 * taken together with those of the two other axes; each side of a surface has its own. */
static inline float surface_lines_area(ps_vec3 normal)
{
    return 1.0f / (fabsf(normal.x) + fabsf(normal.y) + fabsf(normal.z));
}

#endif
