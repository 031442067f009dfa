/* plane_fit.h: a plane fitted to the pixels around one of them (fit.h). */
#ifndef PSPLAT_DENOISER_REGRESSION_PLANE_FIT_H
#define PSPLAT_DENOISER_REGRESSION_PLANE_FIT_H

#include "steering.h"
#include "weights.h"

/* What is fitted. */
struct regression_light {
    const struct regression *on;
    int bandwidth;
    float *const *values;
};

/* Values that are fitted by pixels of the same window. */
struct regression_part {
    struct regression_window window;
    int first, end;
};

struct regression_parts {
    int count;
    struct regression_part of[REGRESSION_IMAGES];
};

/* Fits planes to the values of all parts; D and 1 - cos(normal) are `slack` times as large as said.
 * `plane`: room for one of each value, which the fit borrows. */
void regression_make_fit(const struct regression_light *light, const struct regression_parts *parts,
                         int x, int y, float slack, float (*plane)[3], struct regression_fit *fit);

#endif
