/* tonemap.c: linear radiance to 8-bit display values.
 *
 * Exposure, then a curve on each channel, then the sRGB transfer function, then rounding to the
 * nearest of 256 steps; in double, so that the rounding is that of the exact value. Channels are
 * treated alike and apart: hues shift towards white where they saturate, which is what film does,
 * and what the thesis's clipped pictures do.
 */
#include "image/tonemap.h"

#include <psplat/display.h>

/* Where the filmic curve leaves the straight line, as by default in plugins/tonemap/filmic.c. */
#define SHOULDER 0.6

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

static uint8_t display_byte(float linear, double factor, enum tone_curve curve)
{
    double exposed = linear * factor;
    if (curve == TONE_FILMIC)
        exposed = ps_shoulder(exposed, SHOULDER);
    return (uint8_t)(255.0 * srgb_from_linear(exposed) + 0.5);
}

void tonemap_planes(const float *red, const float *green, const float *blue, size_t n, double stops,
                    enum tone_curve curve, uint8_t *rgb)
{
    double factor = exp2(stops);
    for (size_t i = 0; i < n; i++) {
        rgb[3 * i] = display_byte(red[i], factor, curve);
        rgb[3 * i + 1] = display_byte(green[i], factor, curve);
        rgb[3 * i + 2] = display_byte(blue[i], factor, curve);
    }
}
