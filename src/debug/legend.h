/* legend.h: what the colours of a picture stand for, in a strip with numbers below it. */
#ifndef DEBUG_LEGEND_H
#define DEBUG_LEGEND_H

#include "debug/canvas.h"

/* The next round number: 1, 1.5, 2, 3, 4, 5, 6 or 8 times a power of ten. For 0 or less: 1. */
double legend_top(double largest);

/* The distance between the numbers of a scale from 0 to `top`: 1, 2 or 5 times a power of ten, so
 * that at most `most` fit in, and at least a third of these. */
double legend_step(double top, size_t most);

/* From 0 to `top` by heatmap_colour, of which it leaves out the first `darkest` (0..1), where dots
 * could not be told from what they are drawn on. */
struct legend_scale {
    double top, darkest;
};

struct colour legend_colour(const struct legend_scale *scale, double value);

/* Height of the strip in a picture of that width. */
size_t legend_height(size_t picture_width);

/* Draw a strip from row `y` down: a title, and the scale, or what the numbers 1 to `most` look
 * like by series_colour. */
void legend_draw_scale(struct canvas *canvas, size_t y, const char *title,
                       const struct legend_scale *scale);
void legend_draw_series(struct canvas *canvas, size_t y, const char *title, unsigned most);

#endif
