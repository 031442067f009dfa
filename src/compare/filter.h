/* filter.h: separable filters over a plane, its edges replicated outwards.
 *
 * Two passes of 2r+1 taps rather than one of (2r+1)^2: all of SSIM's and FLIP's kernels are
 * products of a function of x and one of y. Rows are shared out among workers; each pixel is one
 * sum in a fixed order, so the result does not depend on how.
 */
#ifndef COMPARE_FILTER_H
#define COMPARE_FILTER_H

#include "base/error.h"
#include "base/parallel.h"

#define FILTER_MOST_RADIUS 16

struct filter {
    int radius;                                 /* <= FILTER_MOST_RADIUS */
    double weights[2 * FILTER_MOST_RADIUS + 1]; /* of the pixels -radius..radius */
};

/* exp(-x^2 / (2 sigma^2)) at whole x, its sum 1. */
struct filter filter_gaussian(double sigma, int radius);

/* `scratch`: a plane for the first pass. `out` may be `in`. */
void filter_plane(const double *in, size_t width, size_t height, const struct filter *horizontal,
                  const struct filter *vertical, double *scratch, double *out,
                  struct workers *workers);

#endif
