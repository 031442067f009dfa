/* tonemap.h: linear radiance to display values. */
#ifndef IMAGE_TONEMAP_H
#define IMAGE_TONEMAP_H

#include <stddef.h>
#include <stdint.h>

/* The sRGB transfer function of IEC 61966-2-1, linear 0..1 to display 0..1 (clamped; NaN gives 0).
 */
float tonemap_srgb(float linear);

/* Its inverse, display to linear; beyond 1 the formula goes on, negative values are mirrored. */
double tonemap_linear(double display);

/* Display values of a picture's row, from pixel (x, y) on, without a curve: n linear values each,
 * 3n bytes out. They are dithered, since noiseless walls would show the steps between bytes as
 * bands: the mean over a few pixels is right. What lies on a step stays there: 0 and 1 always do.
 * The same pixel has the same dither, whatever part of the picture is written. */
void tonemap_row(const float *red, const float *green, const float *blue, size_t n, uint32_t x,
                 uint32_t y, uint8_t *rgb);

enum tone_curve {
    TONE_CLIP,  /* values above 1 clip: the thesis's display values, and what comparisons use */
    TONE_FILMIC /* that of plugins/tonemap/filmic.c: for pictures that are drawn without plugins */
};

/* `red`, `green`, `blue`: n linear values each; `stops`: exposure, a factor 2^stops; `rgb`: 3n
 * bytes out. */
void tonemap_planes(const float *red, const float *green, const float *blue, size_t n, double stops,
                    enum tone_curve curve, uint8_t *rgb);

#endif
