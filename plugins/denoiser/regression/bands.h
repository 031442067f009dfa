/* bands.h: fits of several bandwidths, added up as far as they are signal (regression.c). */
#ifndef PSPLAT_DENOISER_REGRESSION_BANDS_H
#define PSPLAT_DENOISER_REGRESSION_BANDS_H

#include "images.h"

/* Fills image->sum in, from image->clamped, and image->error. Runs on all workers. */
void regression_add_bands(struct denoised_images *images);

#endif
