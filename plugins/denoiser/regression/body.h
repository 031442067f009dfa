/* body.h: what of a picture is fitted: its irradiance, and of that the body, which has no outliers, with its noise. */
#ifndef PSPLAT_DENOISER_REGRESSION_BODY_H
#define PSPLAT_DENOISER_REGRESSION_BODY_H

#include "work.h"

/* Takes a row of the image: surfaces, and irradiance. For all rows of each image. */
void regression_take_row(void *user, uint64_t row, uint32_t worker);

/* From a first fit of the light, in work->fine, to the body. Runs on all workers. */
void regression_make_body(struct work *work);

#endif
