/* exposure.h: the exposure that suits a picture. */
#ifndef IMAGE_EXPOSURE_H
#define IMAGE_EXPOSURE_H

#include <stddef.h>

/* Stops by which the log-average luminance of n pixels of red, green and blue becomes 0.18. 0 where
 * all are black. */
double exposure_automatic(const float *const light[3], size_t n);

#endif
