/* exr_tiles.h: an OpenEXR file that a picture is written to part by part, for pictures that do not
 * fit into memory.
 *
 * As image_write_exr has it, but for tiles in place of scan lines, which come in the order of the
 * parts.
 */
#ifndef IMAGE_EXR_TILES_H
#define IMAGE_EXR_TILES_H

#include "image/image.h"

#define EXR_TILE_SIDE 64 /* pixels */

struct exr_tiles;

/* Begins a file of a picture of that size, with the channels and attributes of `like`. */
ps_result exr_tiles_create(const char *path, const struct image *like, size_t width, size_t height,
                           enum image_compression compression, struct exr_tiles **tiles,
                           struct error *error);

/* Writes what lies in `place`, a rectangle of the picture whose corner, and whose width and height
 * but at the picture's edge, are multiples of EXR_TILE_SIDE. It lies in the part, whose window says
 * where that is, and has not been written. A channel of the file that the part lacks is 0 there;
 * one that the file lacks is left out. */
ps_result exr_tiles_add(struct exr_tiles *tiles, const struct image *part, struct rectangle place,
                        struct workers *workers, struct error *error);

/* Fills what is missing with zeros, and lets the file appear. The tiles are destroyed in any
 * case. */
ps_result exr_tiles_finish(struct exr_tiles *tiles, struct workers *workers, struct error *error);

/* Instead: there will be no file. NULL is none. */
void exr_tiles_discard(struct exr_tiles *tiles);

#endif
