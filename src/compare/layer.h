/* layer.h: a picture's channels by what they belong to.
 *
 * A layer NAME is the channels NAME.R, NAME.G, NAME.B (a colour), or NAME.X, NAME.Y, NAME.Z (a
 * vector), or the one channel NAME. Without a name it is the picture itself: R, G, B.
 */
#ifndef COMPARE_LAYER_H
#define COMPARE_LAYER_H

#include "image/image.h"

enum layer_kind { LAYER_COLOUR, LAYER_VECTOR, LAYER_SINGLE };

/* Borrows everything from the image. */
struct layer {
    enum layer_kind kind;
    size_t channel_count; /* 1 or 3 */
    const char *names[3];
    float *planes[3];
};

/* `name`: NULL for R, G, B. The error names `path` and the layers that there are. */
ps_result layer_find(const struct image *image, const char *path, const char *name,
                     struct layer *layer, struct error *error);

#endif
