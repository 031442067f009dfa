/* flip.h: LDR-FLIP, the error seen when two pictures alternate in place.
 *
 * P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. Fairchild, "FLIP: A
 * Difference Evaluator for Alternating Images", HPG 2020, with the paper's constants and viewing
 * distance: a display 0.7 m and 3840 pixels wide, seen from 0.7 m.
 *
 * A pixel's error is dEc^(1 - dEf): a colour difference dEc (flip_colour.c), raised where edges or
 * points appear or vanish by a feature difference dEf (flip_feature.c), both in 0..1.
 */
#ifndef COMPARE_FLIP_H
#define COMPARE_FLIP_H

#include "compare/picture_pair.h"

#define FLIP_PIXELS_PER_DEGREE (3840.0 * 3.14159265358979323846 / 180.0) /* 67.02 */
#define FLIP_SCRATCH_PLANES 2

/* Mean over pixels: 0 for identical pictures, at most 1. A single channel counts as grey. */
ps_result flip_mean(const struct picture_pair *pair, double *number, struct error *error);

/* Each pixel's error, of which flip_mean is the mean. */
ps_result flip_map(const struct picture_pair *pair, float *map, struct error *error);

/* XYZ planes, relative to white, to the perceptually uniform, Hunt-adjusted L*a*b* of what the eye
 * resolves; in place. */
void flip_colour_perceived(double *const planes[3], size_t width, size_t height,
                           double *const scratch[FLIP_SCRATCH_PLANES], struct workers *workers);

/* The largest distance that perceived display colours have: that of green to blue. */
double flip_colour_largest_distance(void);

/* dEc of two perceived colours. */
double flip_colour_difference(const double reference[3], const double test[3],
                              double largest_distance);

/* Strength of edges and of points in a plane of relative luminance. */
void flip_features(const double *luminance, size_t width, size_t height, double *edges,
                   double *points, double *const scratch[FLIP_SCRATCH_PLANES],
                   struct workers *workers);

/* dEf of {edge, point} strengths. */
double flip_feature_difference(const double reference[2], const double test[2]);

/* Linear RGB to XYZ relative to white, and back. */
void flip_xyz_from_rgb(const double rgb[3], double xyz[3]);
void flip_rgb_from_xyz(const double xyz[3], double rgb[3]);

#endif
