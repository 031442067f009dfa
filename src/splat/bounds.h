/* bounds.h: boxes around what pixels see, sixteen at a time.
 *
 * Sixteen blocks of 4x4 pixels make a tile, sixteen tiles a node of the pyramid, sixteen nodes the
 * next one: at each step the same loop asks which of sixteen boxes a splat may touch. A box bounds
 * the positions and, as Moreau et al. 2016, "Photon splatting using a view-sample cluster
 * hierarchy", do with cones, the normals: surfaces that face away from the light need no test.
 */
#ifndef SPLAT_BOUNDS_H
#define SPLAT_BOUNDS_H

#include "film/gbuffer.h"

#define BOUNDS_WIDTH 16

/* Sixteen boxes, structure of arrays. An empty one lies at BOUNDS_NOWHERE. */
struct bounds {
    _Alignas(64) float center_x[BOUNDS_WIDTH];
    float center_y[BOUNDS_WIDTH], center_z[BOUNDS_WIDTH];
    float extent_x[BOUNDS_WIDTH], extent_y[BOUNDS_WIDTH], extent_z[BOUNDS_WIDTH];
    float normal_low_x[BOUNDS_WIDTH], normal_low_y[BOUNDS_WIDTH], normal_low_z[BOUNDS_WIDTH];
    float normal_high_x[BOUNDS_WIDTH], normal_high_y[BOUNDS_WIDTH], normal_high_z[BOUNDS_WIDTH];
};

#define BOUNDS_NOWHERE GBUFFER_NOWHERE

/* One box while it grows. */
struct bound {
    ps_vec3 low, high, normal_low, normal_high;
};

/* Holds nothing yet. */
struct bound bound_empty(void);

void bound_add_point(struct bound *bound, ps_vec3 position, ps_vec3 normal);
void bound_add(struct bound *bound, const struct bound *other);

/* Box number i becomes the bound, widened by what rounding may do. */
void bounds_set(struct bounds *bounds, uint32_t i, const struct bound *bound);

#endif
