/* allocation.h: how the samples of a pass are shared out among tiles (adaptive sampling, Zwicker et
 * al. 2015, "Recent advances in adaptive sampling and reconstruction").
 *
 * After a first round of samples, all tiles alike, the error that each tile will have after
 * denoising is estimated. With noise of variance s^2 and light of second derivative c, a fit of
 * bandwidth h has the variance s^2 / h^2 and the bias c h^2; at the best h its error is in
 * proportion to (s^2 c)^(1/3). For c the standard deviation of the means of 4x4 blocks is used. The
 * error is divided by the square root of the brightness, a compromise between the absolute error,
 * by which dark walls would stay noisy, and the relative one. The other samples go where that is
 * large.
 */
#ifndef PSPLAT_ESTIMATOR_ALLOCATION_H
#define PSPLAT_ESTIMATOR_ALLOCATION_H

#include <psplat/plugin.h>

/* What the first round told of a tile, in radiance of no special unit. */
struct tile_pilot {
    uint32_t points;
    float factors;    /* sum over them (sample_factors.h) */
    float brightness; /* mean */
    float noise;      /* variance of a point's noise */
    float variation;  /* variance of the means of its blocks of 4x4 pixels, without their noise */
    float error;      /* for allocation_for() */
};

/* `found`: what the first round found at each of `count` lanes, and `half` what the first half of
 * it did, both of the brightness above. */
struct tile_pilot tile_pilot(const uint32_t *lanes, const float *found, const float *half,
                             size_t count);

/* How many samples are shared out. */
struct allocation_limits {
    uint64_t first;       /* of each point, which are taken */
    uint64_t samples;     /* of a point in the mean, those among them */
    uint64_t least, most; /* of a point whose factor is 1 */
};

/* By what tiles of a picture are given samples. */
struct allocation {
    struct allocation_limits limits;
    float brightness; /* mean of the picture */
    double scale;     /* samples for each unit of error */
};

/* The one by which n tiles keep the limits, as nearly as whole numbers allow. */
struct allocation allocation_for(const struct allocation_limits *limits, struct tile_pilot *pilots,
                                 size_t n);

/* Samples of a point of a tile whose factor is 1. */
uint32_t allocated_samples(const struct allocation *allocation, const struct tile_pilot *pilot);

#endif
