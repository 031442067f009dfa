/* bands.h: fits of several bandwidths, added up as far as they are signal (regression.c). */
#ifndef PSPLAT_DENOISER_REGRESSION_BANDS_H
#define PSPLAT_DENOISER_REGRESSION_BANDS_H

#include "work.h"

/* Fills work->sum in, from the bodies, and work->error. Runs on all workers. */
void regression_add_bands(struct works *works);

#endif
