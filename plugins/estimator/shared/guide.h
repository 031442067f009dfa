/* guide.h: where light comes from, learnt from rays of a tile, so that the next ones go there.
 *
 * Path guiding (Jensen 1995, "Importance driven path tracing using the photon map"; Mueller et al.
 * 2017, "Practical path guiding"): a histogram of the light that rays found, by their direction
 * over the hemisphere around a normal, is what later rays are drawn from. Its bins are equal parts
 * of the hemisphere by projected solid angle, rings by sectors: with even light all are alike, and
 * rays are drawn by the cosine. A share of the rays is drawn by the cosine alone, so that what the
 * histogram has missed is found (defensive sampling, Hesterberg 1995), and each ray is weighed by
 * the pdf of both together.
 *
 * Rays whose light is in a guide may be weighed by it, too (multiple importance sampling). A guide
 * that knows of a bright ray points to it, so weighing that ray by this guide would lose light. So
 * rays are of two halves, and those of either are weighed by what the other half found
 * (cross-fitting, Chernozhukov et al. 2018): by guide_smooth_ratio(), which is smoother than the
 * pdf, since half of the rays tell less.
 */
#ifndef PSPLAT_ESTIMATOR_GUIDE_H
#define PSPLAT_ESTIMATOR_GUIDE_H

#include <psplat/plugin.h>

enum { GUIDE_RINGS = 8, GUIDE_SECTORS = 16, GUIDE_BINS = GUIDE_RINGS * GUIDE_SECTORS };

typedef float guide_bins[GUIDE_RINGS][GUIDE_SECTORS];

struct guide {
    ps_vec3 normal, u, v; /* a frame, of ps_frame */
    guide_bins found[2];  /* sums of the light that rays of either half found */
    float by_cosine;      /* share of the rays */
    /* Of `known` and `smooth`; 0: nothing was found, and what follows is not set. */
    float scale, smooth_scale[2];
    guide_bins known;             /* both, smoothed: the density, but for `scale` */
    guide_bins smooth[2];         /* each, smoothed twice */
    float ring_ends[GUIDE_RINGS]; /* cumulative */
    guide_bins sector_ends;
};

/* What a guide's rays found, in the frame of its normal (ps_frame). */
struct guide_histogram {
    ps_vec3 normal;
    guide_bins found[2];
};

/* Nothing is known yet. */
void guide_begin(struct guide *guide, ps_vec3 normal);

/* Where a direction from a surface lies in a guide's histogram. */
struct guide_bin {
    int32_t index; /* NO_GUIDE_BIN: below the guide's horizon */
    float tilt;    /* its cosine to the guide's normal, over that to the surface's */
};

#define NO_GUIDE_BIN (-1)

struct guide_bin guide_bin_of(const struct guide *guide, ps_vec3 normal, ps_vec3 direction);

/* Adds what a ray of that half, 0 or 1, found: so much irradiance. */
void guide_add(struct guide *guide, int half, struct guide_bin bin, float irradiance);

/* Adds `share` times the mean of another guide's two histograms to each half of this one; none of
 * its own rays may be in it. If the normals differ, bins are mapped by their directions; beyond 45
 * degrees nothing is added. */
void guide_add_histogram(struct guide *guide, const struct guide_histogram *histogram, float share);

/* From now on rays are drawn by what was learnt. */
void guide_update(struct guide *guide);

/* The same where little was learnt, each half by itself: the more directions light comes from, the
 * more rays are drawn by the cosine; all, where that does as well. */
void guide_update_coarse(struct guide *guide);

struct guide_sample {
    ps_vec3 direction;
    struct guide_bin bin; /* where it lies */
    float ratio;          /* guide_ratio() there */
};

/* Draws a direction from a surface of that normal by two numbers of [0, 1). It may lie below the
 * surface. */
struct guide_sample guide_sample(const struct guide *guide, ps_vec3 normal, float a, float b);

/* The pdf of a direction above its surface, over that of the cosine. */
float guide_ratio(const struct guide *guide, struct guide_bin bin);

/* The same for weights: smoother, and by what the rays of the other half found. */
float guide_smooth_ratio(const struct guide *guide, int half, struct guide_bin bin);

#endif
