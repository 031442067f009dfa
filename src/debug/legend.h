/* legend.h: what the colours of a picture stand for, in a strip with numbers below it. */
#ifndef DEBUG_LEGEND_H
#define DEBUG_LEGEND_H

#include "debug/canvas.h"

/* The next round number: 1, 1.5, 2, 3, 4, 5, 6 or 8 times a power of ten. For 0 or less: 1. */
double legend_top(double largest);

/* The distance between the numbers of a scale from 0 to `top`: 1, 2 or 5 times a power of ten, so
 * that at most `most` fit in, and at least a third of these. */
double legend_step(double top, size_t most);

/* The colour of a value on the scale from 0 to `top`, by heatmap_colour. */
struct colour legend_colour(double value, double top);

/* Height of the strip in a picture of that width. */
size_t legend_height(size_t picture_width);

/* Draw a strip from row `y` down: a title, and the scale from 0 to `top`, or what the numbers 1 to
 * `ids` look like by id_colour. */
void legend_draw_scale(struct canvas *canvas, size_t y, const char *title, double top);
void legend_draw_ids(struct canvas *canvas, size_t y, const char *title, unsigned ids);

#endif
