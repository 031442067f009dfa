/* point_tiles.h: points that are no pixels, laid out as tiles that splats light.
 *
 * Point i is lane i % 256 of the i / 256th tile. The pyramid above the tiles groups 4x4 of them; so
 * that tiles which follow each other share its nodes, their places are the base-16 digits of their
 * number, each a place in a square of 4x4. Splats cull well where points next to each other in the
 * order lie close together.
 */
#ifndef SPLAT_POINT_TILES_H
#define SPLAT_POINT_TILES_H

#include "splat/interleaved.h"

/* Tiles for n > 0 points, as a picture n wide and 1 high, and no memory for them. */
struct interleaved point_tiles_layout(size_t n);

/* The tiles of that layout take its points, and their sums are zeroed. Works on `workers`. */
void point_tiles_fill(struct interleaved *tiles, const ps_vec3 *positions, const ps_vec3 *normals,
                      struct workers *workers);

/* The irradiance that splats added to each of the points, W/m^2. */
void point_tiles_read(const struct interleaved *tiles, ps_rgb *irradiance);

#endif
