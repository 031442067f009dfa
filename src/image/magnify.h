/* magnify.h: parts of pictures with pixels large enough to be seen. */
#ifndef IMAGE_MAGNIFY_H
#define IMAGE_MAGNIFY_H

#include "base/rectangle.h"
#include <stdint.h>

/* Copies a part of a picture of 3 bytes a pixel, `width` pixels a row; each pixel becomes a
 * square of zoom * zoom. `magnified`: rows of part.width * zoom pixels; the part must lie in the
 * picture. */
void magnify(const uint8_t *rgb, size_t width, struct rectangle part, size_t zoom,
             uint8_t *magnified);

#endif
