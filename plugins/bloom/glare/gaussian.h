/* gaussian.h: a Gaussian blur of any width in a time that does not depend on it.
 *
 * Three extended boxes along rows, and three along columns (Gwosdek, Grewenig, Bruhn and Weickert
 * 2011, Theoretical foundations of Gaussian convolution by extended box filtering): a box of whole
 * width and a fraction of a pixel at either end, of a third of the variance, by a running sum.
 * Along a line the peak of three of them is 6 % below that of the Gaussian, and the rest is nearer.
 *
 * Lines are mirrored at their ends. So a constant stays, and the sum of all pixels does: each
 * pixel's light lands in the picture whole, also what would have left it.
 */
#ifndef PSPLAT_BLOOM_GAUSSIAN_H
#define PSPLAT_BLOOM_GAUSSIAN_H

#include <psplat/plugin.h>

/* Blurs a plane of width x height pixels in place; variance in square pixels. PS_ERROR_MEMORY;
 * PS_CANCELLED. */
ps_result gaussian_blur(const ps_host *host, float *plane, size_t width, size_t height,
                        double variance);

#endif
