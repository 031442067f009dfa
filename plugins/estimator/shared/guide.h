/* guide.h: where light comes from, learnt from rays of a tile, so that the next ones go there.
 *
 * Path guiding (Jensen 1995, "Importance driven path tracing using the photon map"; Mueller et al. 2017, "Practical path
 * guiding"): a histogram of the light that rays found, by their direction over the hemisphere around a normal, is what
 * later rays are drawn from. Its bins are equal parts of the hemisphere by projected solid angle, rings by sectors: with
 * even light all are alike, and rays are drawn by the cosine. A share of the rays is drawn by the cosine alone, so that
 * what the histogram has missed is found (defensive sampling, Hesterberg 1995), and each ray is weighed by the
 * pdf of both together.
 */
#ifndef PSPLAT_ESTIMATOR_GUIDE_H
#define PSPLAT_ESTIMATOR_GUIDE_H

#include <psplat/plugin.h>

enum { GUIDE_RINGS = 8, GUIDE_SECTORS = 16, GUIDE_BINS = GUIDE_RINGS * GUIDE_SECTORS };

struct guide {
    ps_vec3 normal, u, v;                      /* a frame, of ps_frame */
    float found[GUIDE_RINGS][GUIDE_SECTORS];   /* sums of the light that rays found */
    int ready;                                 /* whether the rest is set */
    float density[GUIDE_RINGS][GUIDE_SECTORS]; /* over that of the cosine */
    float ring_ends[GUIDE_RINGS];              /* cumulative */
    float sector_ends[GUIDE_RINGS][GUIDE_SECTORS];
};

/* Nothing is known yet. */
void guide_begin(struct guide *guide, ps_vec3 normal);

/* A ray found so much irradiance. */
void guide_learn(struct guide *guide, ps_vec3 direction, float irradiance);

/* From now on rays are drawn by what was learnt. */
void guide_update(struct guide *guide);

/* A direction from a surface of that normal by two numbers of [0, 1), and its pdf by solid angle. It may lie below the
 * surface. */
ps_vec3 guide_sample(const struct guide *guide, ps_vec3 normal, float a, float b, float *pdf);

#endif
