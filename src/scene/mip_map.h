/* mip_map.h: a picture at half of its size, at a quarter, and so on to one texel.
 *
 * Williams 1983, "Pyramidal parametrics". A texel of a level has the mean of what it covers of the
 * level before, as light: codes are decoded, averaged and encoded again, so that a picture of one
 * colour stays so. Sides that are odd become half of the next smaller even number; their texels
 * then cover a part of a neighbour as well.
 */
#ifndef SCENE_MIP_MAP_H
#define SCENE_MIP_MAP_H

#include "scene/texture.h"

/* How many levels a picture has, itself among them. */
uint32_t mip_map_level_count(uint32_t width, uint32_t height);

/* Half of a side. */
uint32_t mip_map_half(uint32_t side);

/* Of a level in tiles of 2^tile_shift texels a side; 0: in rows. */
size_t mip_map_level_bytes(const struct texels *level, uint32_t tile_shift, uint32_t texel_bytes);

/* Sizes of the levels from `first` on, by that of level 0, and where they lie, one after the other
 * from `bytes` on, which may be NULL; returns the bytes of all. */
size_t mip_map_place(struct texture *texture, uint32_t first, const unsigned char *bytes);

/* Floats that carry sRGB's function, which none have but those that are said to, have the first
 * level alone. */
bool mip_map_has_more(const struct texture *texture);

/* Adds the levels to a texture that lies in memory, has tables and no levels but the first.
 * PS_ERROR_MEMORY. */
ps_result mip_map_add(struct texture *texture, struct error *error);

#endif
