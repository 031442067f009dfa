/* error_estimate.h: how far the indirect light of a picture is likely to be off.
 *
 * As `psplat compare --metric rel_rmse` would tell it against the truth, of the mean of the three
 * channels: sqrt(sum of squared errors / sum of squares).
 */
#ifndef JOB_ERROR_ESTIMATE_H
#define JOB_ERROR_ESTIMATE_H

#include "film/film_sum.h"
#include "image/image.h"

/* Of a picture with the layers "error" and "indirect": noise and blur, as its denoiser takes them
 * to be. Negative where there is no such layer. */
double error_estimate_of_picture(const struct image *image);

/* Of a film that is not denoised: its noise, by the variance of its passes. It sees no bias.
 * Negative for less than two passes. */
double error_estimate_of_film(const struct film_sum *film);

#endif
