/* box.h: sums over squares of pixels, in a time that does not depend on their size (running
 * sums). */
#ifndef PSPLAT_DENOISER_REGRESSION_BOX_H
#define PSPLAT_DENOISER_REGRESSION_BOX_H

#include <psplat/plugin.h>

struct regression_box {
    size_t width, height, radius;
    float *plane, *room; /* width * height each; the caller's */
};

/* Replaces each value of a plane, none of which is negative, by the sum over the square of 2 radius
 * + 1 pixels around it, as far as that lies in the picture. Runs on all workers. */
void regression_box_sums(const ps_host *host, const struct regression_box *box);

#endif
