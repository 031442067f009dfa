/* cascades.h: grids inside of each other, each half as wide as the next, all of as many cells.
 *
 * Kaplanyan and Dachsbacher 2010. Light that comes from far away may be coarse, light of what is
 * near may not. Each photon is injected into all grids that hold it. A point takes the light of
 * sources in its finest grid from that grid, and from each coarser grid the light of those sources
 * alone that no finer grid holds; so each grid but the finest keeps the two apart. Towards the
 * border of a grid its light fades into what the next one knows of the same sources.
 */
#ifndef PSPLAT_LPV_CASCADES_H
#define PSPLAT_LPV_CASCADES_H

#include "light_grid.h"

#define CASCADES_MOST 8

struct cascade {
    struct blockers blockers;
    struct light_grid own;   /* of sources that no finer grid holds */
    struct light_grid finer; /* of the others; none in the finest */
};

struct cascades {
    const ps_host *host;
    uint32_t count;
    struct cascade items[CASCADES_MOST]; /* the finest first */
};

struct cascades_setting {
    const ps_host *host;
    const ps_pass *pass;
    ps_vec3 focus;          /* which finer grids are around */
    float shift[3];         /* of the grids, in cells: 0..1 */
    uint32_t count, across; /* cascades, cells */
    uint32_t lines_per_cell;
};

/* Grids without light, and what is in its way. Release them whatever it returns. Main thread. */
ps_result cascades_create(const struct cascades_setting *setting, struct cascades *cascades);
void cascades_release(struct cascades *cascades);

/* A photon begins to shine, from half a cell above its surface. False where no grid holds it. */
bool cascades_inject(struct cascades *cascades, const ps_photon *photon);

/* Lets all light go on; see light_grid_propagate. Main thread. */
ps_result cascades_propagate(struct cascades *cascades, uint64_t steps, double least);

/* Irradiance, W/m^2. */
ps_rgb cascades_irradiance(const struct cascades *cascades, ps_vec3 position, ps_vec3 normal);

#endif
