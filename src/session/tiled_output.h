/* tiled_output.h: the files of a picture that is rendered tile by tile; of those, one is in memory
 * at a time, and for PNG files a row of them, 3 bytes a pixel.
 */
#ifndef SESSION_TILED_OUTPUT_H
#define SESSION_TILED_OUTPUT_H

#include "session/output.h"

struct tiled_output;

/* Begins files (output_write has the formats) of a picture of that size, in tiles of side `tile`,
 * of which `first` holds the first: they have its channels, as the options keep them, and its
 * attributes. Workers and options are borrowed. */
ps_result tiled_output_create(const char *const paths[], size_t count,
                              const struct output_options *options, const struct image *first,
                              size_t width, size_t height, size_t tile, struct workers *workers,
                              struct tiled_output **output, struct error *error);

/* Adds a tile, which lies in the part: rows of tiles from the top, each from the left; sizes as
 * exr_tiles_add has them. */
ps_result tiled_output_add(struct tiled_output *output, const struct image *part,
                           struct rectangle tile, struct error *error);

/* Lets the files appear; tiles that were not added are black. The output is destroyed in any
 * case. */
ps_result tiled_output_finish(struct tiled_output *output, struct error *error);

/* Instead: there will be no files. NULL is none. */
void tiled_output_discard(struct tiled_output *output);

#endif
