/* squares.h: sums of the squares of a band, and of its noise, over the squares around pixels.
 *
 * regression.c has the formula that compares their means. Squares count relative to the light
 * (image->inverse_square), and pixels of the kind under way alone (image->current_kind, kinds.h),
 * but for what BROAD ones count among THIN ones. The band is that of `fine` and `coarse`.
 */
#ifndef PSPLAT_DENOISER_REGRESSION_SQUARES_H
#define PSPLAT_DENOISER_REGRESSION_SQUARES_H

#include "images.h"

#include <psplat/isa.h>

enum { REGRESSION_NARROW = 6 }; /* R of bands, up to which the noise is corrected */

/* What pixels count for in the sums of a band of R = `radius`, which is the same for all images:
 * image->signal_weight and noise_weight. */
void regression_count_squares(struct denoised_image *image, int radius);

/* B^2 in image->signal, over a square of that radius, and N^2 in image->noise, over one twice as
 * wide. */
void regression_measure_squares(struct denoised_image *image, int radius);

/* Sums over pixels that count for so much in all become means; where there are none, sums are 0. */
static PS_INLINED float regression_mean_of(float sum, float count)
{
    return sum / (count > 0.0f ? count : 1.0f);
}

#endif
