/* canvas.h: a picture of bytes to draw on. What lies outside of it is left out. */
#ifndef DEBUG_CANVAS_H
#define DEBUG_CANVAS_H

#include "base/error.h"
#include "base/rectangle.h"

/* Zero-initialise before the first use. */
struct canvas {
    size_t width, height;
    uint8_t *rgb; /* sRGB, row-major, owned */
};

struct colour {
    uint8_t r, g, b;
};

/* Black. */
ps_result canvas_create(struct canvas *canvas, size_t width, size_t height, struct error *error);
void canvas_release(struct canvas *canvas);

void canvas_set(struct canvas *canvas, long x, long y, struct colour colour);
struct colour canvas_get(const struct canvas *canvas, size_t x, size_t y);
void canvas_fill(struct canvas *canvas, struct rectangle part, struct colour colour);

/* All pixels whose centres lie within `radius` of the point; at least the one that it lies in. */
void canvas_disc(struct canvas *canvas, float x, float y, float radius, struct colour colour);

/* A straight line, a pixel wide. */
void canvas_line(struct canvas *canvas, float from_x, float from_y, float to_x, float to_y,
                 struct colour colour);

/* One line of text, its upper left corner at (x, y), in letters of font.h, `scale` times as
 * large. */
void canvas_text(struct canvas *canvas, long x, long y, size_t scale, struct colour colour,
                 const char *text);
size_t canvas_text_width(size_t scale, const char *text);

/* The size of letters that can be read in a picture of that width. */
size_t canvas_text_scale(size_t picture_width);

/* Copies pixels in, `width` a row. */
void canvas_paste(struct canvas *canvas, size_t x, size_t y, const uint8_t *rgb, size_t width,
                  size_t height);

#endif
