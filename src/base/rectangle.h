/* rectangle.h: a part of a picture. */
#ifndef BASE_RECTANGLE_H
#define BASE_RECTANGLE_H

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

/* Where a part of a picture lies in it. */
struct picture_window {
    size_t left, top;                     /* its upper left pixel */
    size_t picture_width, picture_height; /* of the whole; 0: the part is all there is */
};

static inline bool picture_window_same(struct picture_window a, struct picture_window b)
{
    return a.left == b.left && a.top == b.top && a.picture_width == b.picture_width &&
           a.picture_height == b.picture_height;
}

#endif
