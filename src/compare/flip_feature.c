/* flip_feature.c: FLIP's feature pipeline (section 4.2 of the paper).
 *
 * Edges are found by the first derivative of a Gaussian, points (and lines) by the second, its
 * width that of the eye's edge detectors; their strength is the length of the vector of the x and y
 * responses. Weights above zero are scaled to sum to 1, those below to -1, so that responses lie in
 * -1..1. The sign of a kernel's weight is that of its derivative factor, so the scaling, too, is
 * separable.
 */
#include "compare/filter.h"
#include "compare/flip.h"

#include <math.h>

#define DETECTOR_WIDTH 0.082 /* degrees, peak to trough: two standard deviations */
#define QF 0.5

static struct filter scale_signs_apart(struct filter filter)
{
    double above = 0.0, below = 0.0;
    for (int i = 0; i <= 2 * filter.radius; i++) {
        above += fmax(filter.weights[i], 0.0);
        below += fmax(-filter.weights[i], 0.0);
    }
    for (int i = 0; i <= 2 * filter.radius; i++)
        filter.weights[i] /= filter.weights[i] > 0.0 ? above : below;
    return filter;
}

static void filter_strength(const double *in, size_t width, size_t height,
                            const struct filter *derivative, const struct filter *smooth,
                            double *const scratch[FLIP_SCRATCH_PLANES], struct workers *workers,
                            double *strength)
{
    filter_plane(in, width, height, derivative, smooth, scratch[0], strength, workers);
    filter_plane(in, width, height, smooth, derivative, scratch[0], scratch[1], workers);
    for (size_t i = 0; i < width * height; i++)
        strength[i] = hypot(strength[i], scratch[1][i]);
}

void flip_features(const double *luminance, size_t width, size_t height, double *edges,
                   double *points, double *const scratch[FLIP_SCRATCH_PLANES],
                   struct workers *workers)
{
    double sigma = 0.5 * DETECTOR_WIDTH * FLIP_PIXELS_PER_DEGREE;
    int radius = (int)ceil(3.0 * sigma);
    struct filter smooth = filter_gaussian(sigma, radius), first = smooth, second = smooth;
    for (int i = -radius; i <= radius; i++) {
        first.weights[i + radius] *= -i;
        second.weights[i + radius] *= i * i / (sigma * sigma) - 1.0;
    }
    first = scale_signs_apart(first);
    second = scale_signs_apart(second);
    filter_strength(luminance, width, height, &first, &smooth, scratch, workers, edges);
    filter_strength(luminance, width, height, &second, &smooth, scratch, workers, points);
}

double flip_feature_difference(const double reference[2], const double test[2])
{
    double larger = fmax(fabs(reference[0] - test[0]), fabs(reference[1] - test[1]));
    return pow(larger / sqrt(2.0), QF);
}
