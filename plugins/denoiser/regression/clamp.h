/* clamp.h: the input of the fits: the irradiance, the same with outliers limited, and a picture of
 * its noise. */
#ifndef PSPLAT_DENOISER_REGRESSION_CLAMP_H
#define PSPLAT_DENOISER_REGRESSION_CLAMP_H

#include "images.h"

/* Takes a row of the image: surfaces, and irradiance. For all rows of each image. */
void regression_take_row(void *user, uint64_t row, uint32_t worker);

/* From a first fit of the light, in image->fine, to image->clamped. Runs on all workers. */
void regression_clamp_outliers(struct denoised_image *image);

#endif
