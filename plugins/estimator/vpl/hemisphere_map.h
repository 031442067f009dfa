/* hemisphere_map.h: what a virtual point light sees of its surroundings, found by a few rays.
 *
 * Hoet 2014, chapter 6, proposes as its last idea to find what a photon lights by casting rays for
 * lights over hemispheres, too, whose visibility is what costs. So rays go from the light through
 * the cells of a grid over its hemisphere, as in a hemispherical shadow map (Brabec et al. 2002),
 * and each cell keeps a point q of the surface that its ray met, with its normal. A point p of that
 * cell is hidden by q if it lies behind the plane of q, and q before its own:
 *
 *     dot(p - q, n_q) < 0  and  dot(q - p, n_p) > 0
 *
 * Distances alone would let a wall that is seen at a flat angle shadow itself, and the planes of q
 * alone would the sides of a box: points of a convex surface lie behind each other's planes. What
 * is smaller than a cell is seen by chance, and shadows' edges shift by up to half of one. The turn
 * of the grid is random, so that lights differ in that.
 *
 * The hemisphere is mapped to the square of cells by the octahedron (Cigolle et al. 2014, "A survey
 * of efficient representations for independent unit vectors").
 */
#ifndef PSPLAT_ESTIMATOR_HEMISPHERE_MAP_H
#define PSPLAT_ESTIMATOR_HEMISPHERE_MAP_H

#include <psplat/plugin.h>

struct hemisphere_hit {
    ps_vec3 position; /* from the light */
    ps_vec3 normal;   /* on the light's side; 0: the cell's ray met nothing */
};

struct hemisphere_map {
    ps_vec3 axis_u, axis_v, axis_w; /* of the grid; w is the light's normal */
    uint32_t resolution;            /* cells along a side */
    struct hemisphere_hit *cells;   /* resolution * resolution; borrowed */
};

/* Casts the rays of a light at `origin`, which is off its surface already. `turn` in [0, 1): of the
 * grid. The map's cells and resolution are set by the caller. Any thread. */
void hemisphere_map_cast(const ps_host *host, ps_vec3 origin, ps_vec3 normal, float turn,
                         struct hemisphere_map *map);

/* PS_TILE_PIXELS of them, borrowed. */
struct hemisphere_points {
    const float *x, *y, *z; /* from the light */
    const float *normal_x, *normal_y, *normal_z;
};

/* What is `carried` to points becomes 0 where something hides them from the light. Any thread. */
void hemisphere_map_occlude(const struct hemisphere_map *map,
                            const struct hemisphere_points *points, float *carried);

#endif
