/* light_grid.h: light that goes from cell to cell of a grid, and what is in its way.
 *
 * Kaplanyan and Dachsbacher 2010. The light of a cell is radiant intensity I(w), W/sr, as if all of
 * it left the cell's middle, in spherical harmonics of order 1. In one step it goes to the six
 * cells beside. Of each of these, five faces are seen from the middle of the first, each at a solid
 * angle W around the direction w of its middle; the flux
 *
 *     Phi = W max(0, I(w)) (1 - a)
 *
 * that reaches a face goes on as a lobe Phi / pi max(0, n.w) along the normal n of that face. The
 * sum of I over all steps is the light field.
 *
 * The 30 faces cover the sphere, so flux stays, but for the clamp: order 1 is negative opposite to
 * a narrow lobe, and what the clamp leaves is 14 % more. It is divided by that, for each cell and
 * channel; without, light grows from step to step.
 *
 * What is in the way: `a` is the share of the face between the two cells that surfaces cover. The
 * paper keeps blockers as spherical harmonics of their normals, too; but both sides of a thin wall
 * would add up to a half of blocking in all directions. Surfaces count at the face that is nearest
 * along an axis, as the paper has them half a cell shifted.
 */
#ifndef PSPLAT_LPV_LIGHT_GRID_H
#define PSPLAT_LPV_LIGHT_GRID_H

#include "../shared/spherical_harmonics.h"
#include "../shared/surface_lines.h"

#define LPV_MEMORY "light propagation volumes"

/* What covers the faces of a grid's cells. */
struct blockers {
    const ps_host *host;
    struct voxel_grid grid;
    float *faces[3]; /* across axis k, before each of across + 1 cells along it: 0..1; owned */
};

/* Finds them by `per_cell` times `per_cell` lines through each cell. Release it whatever it
 * returns. Main thread. */
ps_result blockers_create(const struct surface_lines *lines, struct blockers *blockers);
void blockers_release(struct blockers *blockers);

/* Number of a face across an axis; `cell` is the cell behind it, along the axis. */
static inline size_t blockers_face(const struct voxel_grid *grid, uint32_t axis,
                                   const uint32_t cell[3])
{
    size_t n = grid->across;
    return (cell[(axis + 2) % 3] * n + cell[(axis + 1) % 3]) * (n + 1) + cell[axis];
}

struct light_grid {
    const ps_host *host;
    struct voxel_grid grid;
    struct sh_rgb *field;      /* the sum over all steps; owned, as the others */
    struct sh_rgb *now, *next; /* light of a step */
    ps_rgb *shares;            /* what flux is divided by for the clamp */
};

/* A grid without light. Release it whatever it returns. */
ps_result light_grid_create(const ps_host *host, const struct voxel_grid *grid,
                            struct light_grid *light);
void light_grid_release(struct light_grid *light);

/* Adds a lobe of that power (W) to the cell around a position; does nothing outside. */
void light_grid_inject(struct light_grid *light, ps_vec3 position, ps_vec3 axis, ps_rgb power);

/* Lets the light go on that many steps, or until no more than a share `least` of its power is left
 * in the grid. Main thread. */
ps_result light_grid_propagate(struct light_grid *light, const struct blockers *blockers,
                               uint64_t steps, double least);

/* Irradiance, W/m^2, at a position on a surface with that normal: half a cell above it,
 * interpolated between the eight cells around, but for those whose middle is below the surface. 0
 * outside. */
ps_rgb light_grid_irradiance(const struct light_grid *light, ps_vec3 position, ps_vec3 normal);

#endif
