/* enlarge.h: a picture scaled up smoothly: bilinear between the centres of its pixels. */
#ifndef IMAGE_ENLARGE_H
#define IMAGE_ENLARGE_H

#include "image/image.h"

/* How large: each pixel becomes a square of `step`, of which the last column and row may be cut. */
struct enlargement {
    double step;
    size_t width, height;
};

/* Makes `large` of the channels that `keeps` is true of, without attributes; the caller releases
 * it. When out of memory, PS_ERROR_MEMORY, there is none. */
ps_result image_enlarge(const struct image *image, struct enlargement to,
                        bool (*keeps)(const char *channel), struct workers *workers,
                        struct image *large, struct error *error);

#endif
