/* roughness.h: pbrt's roughness as psplat's.
 *
 * psplat's is the square root of alpha of the GGX distribution (psd(5)). pbrt's is alpha, or with
 * `remaproughness` a number from which alpha follows: pbrt-v4 alpha = sqrt(r); pbrt-v3, with x = ln
 * max(r, 0.001),
 *     alpha = 1.62142 + 0.819955 x + 0.1734 x^2 + 0.0171201 x^3 + 0.000640711 x^4
 * (TrowbridgeReitzDistribution::RoughnessToAlpha of either).
 */
#ifndef PBRT_ROUGHNESS_H
#define PBRT_ROUGHNESS_H

#include "pbrt/texture.h"

/* From a number of pbrt's, remapped or not; 0..1. */
double roughness_from(double value, bool remap, int version);

/* Of the parameters PREFIXroughness, PREFIXuroughness, PREFIXvroughness and remaproughness. */
struct pattern roughness_read(struct importer *importer, const struct statement *statement,
                              const char *prefix, double otherwise);

#endif
