/* guide.h: where light comes from, learnt from rays of a tile, so that the next ones go there.
 *
 * Path guiding (Jensen 1995, "Importance driven path tracing using the photon map"; Mueller et al. 2017, "Practical path
 * guiding"): a histogram of the light that rays found, by their direction over the hemisphere around a normal, is what
 * later rays are drawn from. Its bins are equal parts of the hemisphere by projected solid angle, rings by sectors: with
 * even light all are alike, and rays are drawn by the cosine. A share of the rays is drawn by the cosine alone, so that
 * what the histogram has missed is found (defensive sampling, Hesterberg 1995), and each ray is weighed by the
 * pdf of both together.
 *
 * Rays that a guide learnt from may be weighed by it, too (multiple importance sampling). Where a ray was lucky, the guide
 * points there because of it, so that such weights would lose light. And rays are stratified: those beside it are elsewhere,
 * and without it the guide would know too little of its direction. So guide_smooth_ratio() has, in place of what a ray found,
 * what others of its bin did on average; and it is smoother than the pdf, so that what is left of this, which the curvature
 * of the weights makes of chance, is less than half a percent.
 */
#ifndef PSPLAT_ESTIMATOR_GUIDE_H
#define PSPLAT_ESTIMATOR_GUIDE_H

#include <psplat/plugin.h>

enum { GUIDE_RINGS = 8, GUIDE_SECTORS = 16, GUIDE_BINS = GUIDE_RINGS * GUIDE_SECTORS };

struct guide {
    ps_vec3 normal, u, v;                     /* a frame, of ps_frame */
    float found[GUIDE_RINGS][GUIDE_SECTORS];  /* sums of the light that rays found */
    float rays[GUIDE_RINGS][GUIDE_SECTORS];   /* how many they were, or would be by the cosine */
    int ready;                                /* whether the rest is set */
    float known[GUIDE_RINGS][GUIDE_SECTORS];  /* `found`, smoothed: the density, but for a factor */
    float smooth[GUIDE_RINGS][GUIDE_SECTORS]; /* the same, smoothed twice */
    float total, smooth_total;                /* of these */
    float ring_ends[GUIDE_RINGS];             /* cumulative */
    float sector_ends[GUIDE_RINGS][GUIDE_SECTORS];
};

/* Nothing is known yet. */
void guide_begin(struct guide *guide, ps_vec3 normal);

/* A ray found so much irradiance, in a direction whose pdf was `ratio` of that of the cosine. */
void guide_learn(struct guide *guide, ps_vec3 direction, float irradiance, float ratio);

/* From now on rays are drawn by what was learnt. */
void guide_update(struct guide *guide);

/* A direction from a surface of that normal by two numbers of [0, 1). It may lie below the surface. */
ps_vec3 guide_sample(const struct guide *guide, ps_vec3 normal, float a, float b);

/* The pdf of a direction above that surface, over that of the cosine. */
float guide_ratio(const struct guide *guide, ps_vec3 normal, ps_vec3 direction);

/* The same by smoother light, for weights. `learnt`: the irradiance of a ray by the cosine that guide_learn() was told for
 * this direction, in place of which others count; 0: all counts. */
float guide_smooth_ratio(const struct guide *guide, ps_vec3 normal, ps_vec3 direction,
                         float learnt);

#endif
