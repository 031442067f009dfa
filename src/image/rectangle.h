/* rectangle.h: a part of a picture. */
#ifndef IMAGE_RECTANGLE_H
#define IMAGE_RECTANGLE_H

#include <stdbool.h>
#include <stddef.h>

struct rectangle {
    size_t x, y, width, height; /* pixels; the corner is the upper left */
};

/* Whether it holds a pixel, and lies in a picture of that size. */
static inline bool rectangle_fits(struct rectangle part, size_t width, size_t height)
{
    return part.width > 0 && part.height > 0 && part.x < width && part.y < height &&
           part.width <= width - part.x && part.height <= height - part.y;
}

#endif
