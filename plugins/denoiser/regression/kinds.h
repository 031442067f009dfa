/* kinds.h: pixels whose bands are measured together.
 *
 * A band is kept as far as its mean square exceeds that of its noise (regression.c), both over a
 * square around a pixel, and a square shows several surfaces. What gloss mirrors has noise of its
 * own, which says nothing about the walls around. What is thin, the underside of a beam or the edge
 * of a table top, is a few pixels among many of a wall whose narrow bands are empty: it would be
 * blurred as the wall may be, and the wall would keep noise for its sake. So each of these kinds
 * has means of its own. Those of what is thin are of few pixels, so that the wall's count for a
 * little among them.
 */
#ifndef PSPLAT_DENOISER_REGRESSION_KINDS_H
#define PSPLAT_DENOISER_REGRESSION_KINDS_H

#include "images.h"

/* Fills in image->kind, and which kinds there are, when the guides are there. */
void regression_kinds_find(struct denoised_images *images);

#endif
