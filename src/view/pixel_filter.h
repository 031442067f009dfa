/* pixel_filter.h: where in and around a pixel a pass looks.
 *
 * Anti-aliasing is the mean of passes whose points are drawn by the filter's own shape (Ernst et
 * al. 2006): every pass then counts the same, and light stays in its pixel. Filters with negative
 * lobes can't be drawn from.
 */
#ifndef VIEW_PIXEL_FILTER_H
#define VIEW_PIXEL_FILTER_H

#include "scene/description.h"

/* The point (from the pixel's upper left corner, in pixels) for two numbers in [0,1): evenly over
 * the pixel; by a tent that reaches its neighbours' centres; or by a gaussian of deviation 1/2, cut
 * at 3/2. */
void pixel_filter_point(enum pixel_filter filter, const float numbers[2], float point[2]);

#endif
