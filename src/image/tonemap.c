/* tonemap.c: linear radiance to 8-bit display values.
 *
 * Exposure, then a curve on each channel, then the sRGB transfer function, then rounding to the
 * nearest of 256 steps, or for pictures, which are dithered, to one of the two nearest; in double,
 * so that the rounding is that of the exact value. Channels are treated alike and apart: hues shift
 * towards white where they saturate, which is what film does, and what the thesis's clipped
 * pictures do.
 */
#include "image/tonemap.h"

#include <psplat/display.h>

/* Where the filmic curve leaves the straight line, as by default in plugins/tonemap/filmic.c. */
#define SHOULDER 0.6

#define LARGEST_DITHER 0.49 /* of a step: what lies on one stays there */

/* IEC 61966-2-1: 12.92 x up to 0.0031308, 1.055 x^(1/2.4) - 0.055 beyond. */
static double srgb_from_linear(double linear)
{
    if (!(linear > 0.0)) { /* NaN too */
        return 0.0;
    }
    if (linear >= 1.0)
        return 1.0;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

float tonemap_srgb(float linear)
{
    return (float)srgb_from_linear(linear);
}

double tonemap_linear(double display)
{
    double size = fabs(display);
    double linear = size <= 0.04045 ? size / 12.92 : pow((size + 0.055) / 1.055, 2.4);
    return copysign(linear, display);
}

static uint8_t display_byte(float linear, double factor, enum tone_curve curve, double dither)
{
    double exposed = linear * factor;
    if (curve == TONE_FILMIC)
        exposed = ps_shoulder(exposed, SHOULDER);
    return (uint8_t)(255.0 * srgb_from_linear(exposed) + 0.5 + dither);
}

/* Less than half a step of the 256 either way: interleaved gradient noise (Jimenez 2014, "Next
 * generation post processing in Call of Duty: Advanced Warfare"), whose values are spread evenly
 * over any few neighbouring pixels. */
static double dither_at(uint32_t x, uint32_t y)
{
    double inner = 0.06711056 * (double)x + 0.00583715 * (double)y;
    double outer = 52.9829189 * (inner - floor(inner));
    return LARGEST_DITHER * (2.0 * (outer - floor(outer)) - 1.0);
}

void tonemap_row(const float *red, const float *green, const float *blue, size_t n, uint32_t x,
                 uint32_t y, uint8_t *rgb)
{
    for (size_t i = 0; i < n; i++) {
        double dither = dither_at(x + (uint32_t)i, y);
        rgb[3 * i] = display_byte(red[i], 1.0, TONE_CLIP, dither);
        rgb[3 * i + 1] = display_byte(green[i], 1.0, TONE_CLIP, dither);
        rgb[3 * i + 2] = display_byte(blue[i], 1.0, TONE_CLIP, dither);
    }
}

void tonemap_planes(const float *red, const float *green, const float *blue, size_t n, double stops,
                    enum tone_curve curve, uint8_t *rgb)
{
    double factor = exp2(stops);
    for (size_t i = 0; i < n; i++) {
        rgb[3 * i] = display_byte(red[i], factor, curve, 0.0);
        rgb[3 * i + 1] = display_byte(green[i], factor, curve, 0.0);
        rgb[3 * i + 2] = display_byte(blue[i], factor, curve, 0.0);
    }
}
