/* ssim.h: structural similarity.
 *
 * Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image Quality Assessment: From Error Visibility to
 * Structural Similarity", IEEE TIP 13(4), 2004, equation 13 with the paper's constants, over the
 * luminance of the display values (0.2126 R' + 0.7152 G' + 0.0722 B', range 1).
 */
#ifndef COMPARE_SSIM_H
#define COMPARE_SSIM_H

#include "compare/picture_pair.h"

/* Mean over the pixels whose window lies within the picture: 1 for identical pictures. In a picture
 * narrower or lower than the window it is the mean over that whole axis, edges replicated. */
ps_result ssim_mean(const struct picture_pair *pair, double *number, struct error *error);

#endif
