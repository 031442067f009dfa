/* exposure.c: the log-average luminance of a picture is brought to middle grey (Reinhard et al.
 * 2002, Photographic tone reproduction for digital images, equation 1).
 *
 *     stops = log2(0.18) - mean of log2 L
 *
 * Black pixels, such as the void around a scene, are left out, where Reinhard adds a small number
 * to each; and so are the darkest and the brightest hundredth of the others, among which are
 * fireflies and lights. A histogram finds these: the upper bits of a float number its octave and 64
 * steps in it, so the mean is exact to 0.012 stops, and counts do not depend on the order of
 * pixels.
 */
#include "image/exposure.h"

#include <math.h>
#include <psplat/math.h>
#include <stdint.h>
#include <string.h>

#define MIDDLE_GREY 0.18
#define TRIMMED_SHARE 0.01

enum { STEP_BITS = 6, SHIFT = 23 - STEP_BITS, BINS = 256 << STEP_BITS };

static uint32_t bin_of(float luminance)
{
    uint32_t bits;
    memcpy(&bits, &luminance, sizeof bits);
    return bits >> SHIFT;
}

/* log2 of the luminance in the middle of a bin. */
static double middle_of(uint32_t bin)
{
    uint32_t bits = bin << SHIFT | 1u << (SHIFT - 1);
    float luminance;
    memcpy(&luminance, &bits, sizeof luminance);
    return log2((double)luminance);
}

static void count_pixels(const float *const light[3], size_t n, uint64_t counts[BINS])
{
    for (size_t i = 0; i < n; i++) {
        float luminance = ps_luminance((ps_rgb){light[0][i], light[1][i], light[2][i]});
        if (luminance > 0.0f && luminance < INFINITY)
            counts[bin_of(luminance)]++;
    }
}

/* Over the pixels of ranks from `first` to before `last`, where rank 0 is the darkest. */
static double mean_log(const uint64_t counts[BINS], uint64_t first, uint64_t last)
{
    double sum = 0.0;
    uint64_t rank = 0;
    for (uint32_t bin = 0; bin < BINS; bin++) {
        uint64_t low = rank > first ? rank : first;
        rank += counts[bin];
        uint64_t high = rank < last ? rank : last;
        if (high > low)
            sum += (double)(high - low) * middle_of(bin);
    }
    return sum / (double)(last - first);
}

double exposure_automatic(const float *const light[3], size_t n)
{
    uint64_t counts[BINS] = {0}, lit = 0;
    count_pixels(light, n, counts);
    for (uint32_t bin = 0; bin < BINS; bin++)
        lit += counts[bin];
    uint64_t trimmed = (uint64_t)(TRIMMED_SHARE * (double)lit);
    return lit > 0 ? log2(MIDDLE_GREY) - mean_log(counts, trimmed, lit - trimmed) : 0.0;
}
