/* steering.h: windows of fits that follow the edges of light.
 *
 * Light changes across the edge of a shadow, and hardly along it. A window that is narrow across
 * and long along blurs less than a round one of as many pixels (steering kernel regression, Takeda
 * et al. 2007, "Kernel regression for image processing and reconstruction"). With g the gradient of
 * the light E that is known so far, and R the bandwidth, it is an ellipse, R / sqrt(s) across and R
 * sqrt(s) along the edge:
 *
 *     s = min(1 + STRENGTH R |g| / E, LONGEST)
 *
 * In gloss windows are round: what it mirrors by chance has edges of its own, which seldom are
 * those of light.
 */
#ifndef PSPLAT_DENOISER_REGRESSION_STEERING_H
#define PSPLAT_DENOISER_REGRESSION_STEERING_H

#include "fit.h"

/* Pixels (x, y) away from the middle are inside where xx x^2 + 2 xy x y + yy y^2 < 1. */
struct regression_window {
    float xx, xy, yy;
};

struct regression_window regression_round_window(int bandwidth);

/* That of a fit around a pixel; any if no surface is seen there. */
struct regression_window regression_steered_window(const struct regression *regression,
                                                   const struct regression_steering *by,
                                                   int bandwidth, int x, int y);

/* Rows to either side of the middle that a window reaches, and of such a row the first and the last
 * pixel; false: none. All that are inside are among them, and they are no more than
 * REGRESSION_MARGIN away. */
int regression_window_rows(const struct regression_window *window);
bool regression_window_row(const struct regression_window *window, int y, int *first, int *last);

#endif
