/* kernel.h: the inner loop: splats against the pixels of a tile.
 *
 * For every splat and every pixel p of the tile, with d = p - centre:
 *
 *     u = d.U / R, v = d.V / R, t = d.W         position in the box
 *     h                                         the part of the disc that the pixel takes
 *                                               (bandwidth.h), of R
 *     r^2 = (u^2 + v^2) / h^2
 *     k = profile(r^2) * scale / (h R)^2        the kernel K, 1/m^2, integrates to 1 over its disc
 *     lit where u^2 + v^2 < 1, r^2 < 1, near <= t <= far, n.W < 0, t lies past the plane that the
 *     bundle starts on, and not past the map by more than the bias
 *     irradiance += power * k * max(0, -n.W), weight += merged * k
 *
 * A bundle starts a little above its photon's surface (footprint_clearance); for a pixel that takes
 * less of the disc, by as much less, so that where two surfaces meet light reaches the crease.
 *
 * Near to the photon's plane pixels get a part of the light only (gather_share.h): the rest is the
 * estimator's.
 *
 * A splat that stands for several photons weighs as much as they would (Hoet 2014, section 3.2.1);
 * the loop has that as a larger k of a lesser power.
 *
 * Where the photon has boundaries beside it (boundary.h), k is divided by the part of the kernel
 * that they leave.
 *
 * The cosine is there because K lies in the plane across the bundle. Blocks of 16 pixels whose
 * bounds the box does not touch are left out, and a block is left as soon as no pixel of it can be
 * lit: after they are placed, after they chose their widths, and after they are weighed. No
 * branches from lane to lane: masks and gathers (from the depth map, the profile, and what
 * boundaries leave), so that compilers turn the loops into 8 or 16 lanes. It is compiled once for
 * each instruction set (kernel_variant.c) and chosen at run time; a pixel's sum runs in splat
 * order.
 */
#ifndef SPLAT_KERNEL_H
#define SPLAT_KERNEL_H

#include "placement/bandwidth.h"
#include "placement/gather_share.h"
#include "placement/splat.h"
#include "splat/interleaved.h"
#include <stdbool.h>

#define KERNEL_PROFILE_SIZE 1024
#define KERNEL_BOUNDARY_SIZE 257
#define KERNEL_LEAST_LEFT 0.0625f /* boundaries make no splat brighter than 16 times */

/* A filter, tabulated over squared radius. */
struct kernel_profile {
    float weights[KERNEL_PROFILE_SIZE]; /* entry i stands for [i, i + 1) / KERNEL_PROFILE_SIZE */
    float scale;                        /* 1 / integral of the weights over the unit disc */
    bool counting;                      /* K is 1 all over the disc, whatever its size */
    float beyond[KERNEL_BOUNDARY_SIZE]; /* the part of K beyond a straight border at distance
                                             i / (KERNEL_BOUNDARY_SIZE - 1) */
};

/* A splat with all that can be worked out once for all pixels. */
struct kernel_splat {
    ps_vec3 centre;
    ps_vec3 u, v; /* axes divided by the radius */
    ps_vec3 w;
    float near_depth, far_depth;
    float photon_depth, start_u,
        start_v;     /* depth of the photon's plane: photon_depth + start_u * u + start_v * v */
    float clearance; /* from there to the start plane */
    struct gather_share near; /* which part of the light pixels get, by their distance from there */
    struct bandwidth width;
    float bias_constant, bias_slope;
    float by_width;     /* 1: k goes by 1 / h^2; 0: it is the same for all pixels (counting) */
    float kernel_scale; /* with `merged` in it, by which the power is divided, and the number of
                           subsets of the pixels; 0: the splat lights
                           nothing, and has no other member set */
    ps_rgb power;
    uint32_t subset;     /* of the interleaved pixels, which it lights */
    const float *depths; /* resolution^2 */
    uint32_t boundary_count;
    ps_boundary boundaries[PS_MOST_BOUNDARIES];
    float boundaries_likeness; /* of two boundaries: 2 / pi * asin of their normals' cosine */
};

/* How far past the photon's plane a point lies, along the bundle. */
static inline float kernel_above(const struct kernel_splat *splat, float u, float v, float t)
{
    return t - (splat->photon_depth + u * splat->start_u + v * splat->start_v);
}

/* Where a start lies behind a wall; before it, no more than half of the kernel lies beyond. */
#define KERNEL_BEHIND 1.0f

/* The part of a kernel that two straight borders leave, of which `one` and `other` lie beyond each;
 * `likeness` as kernel_splat.boundaries_likeness. Beyond both lies nothing where the borders face
 * each other (-1), the product where they stand at right angles (0; exact for a Gaussian), the
 * lesser part where they are parallel (1); in between, what lies in between, exact for any round
 * kernel whose middle lies on both. */
static inline float kernel_left(float one, float other, float likeness)
{
    float product = one * other, lesser = one < other ? one : other;
    float more = likeness < 0.0f ? product : lesser - product;
    float left = 1.0f - one - other + product + likeness * more;
    return left > KERNEL_LEAST_LEFT ? left : KERNEL_LEAST_LEFT;
}

struct kernel_count {
    uint64_t tests; /* of pixels against splats */
    uint64_t lit;   /* those with weight */
};

/* The pixels of a tile that have weight. */
struct kernel_weighed {
    uint32_t lanes[PS_TILE_PIXELS];
    float weight[PS_TILE_PIXELS], projected[PS_TILE_PIXELS]; /* K, and that times the cosine */
};

struct kernel_variant {
    const char *name; /* instruction set */
    /* Adds n splats, in order, to the tile. */
    struct kernel_count (*accumulate)(struct interleaved_tile *tile,
                                      const struct kernel_splat *splats, const uint32_t *indices,
                                      size_t n, uint32_t resolution,
                                      const struct kernel_profile *profile);
    /* What a splat would give to a tile with nothing in the way (its map has one texel, at
     * INFINITY); returns to how many pixels. */
    uint32_t (*weigh)(const struct interleaved_tile *tile, const struct kernel_splat *splat,
                      const struct kernel_profile *profile, struct kernel_weighed *weighed);
    /* Which of sixteen boxes the splat's box may touch, as bits. */
    uint32_t (*touch)(const struct bounds *bounds, const struct kernel_splat *splat);
};

/* The variants that this processor can run, best first; the last is the baseline. */
size_t kernel_variants(struct kernel_variant variants[4]);

/* The variant of that name, or the best one where name is NULL. False if this processor can't run
 * it. */
bool kernel_choose(const char *name, struct kernel_variant *variant);

/* Tabulates a radial weight given at the KERNEL_PROFILE_SIZE midpoints and normalizes it. False
 * when it is negative or NaN somewhere or zero all over. */
int kernel_profile_normalize(struct kernel_profile *profile);

/* For diagnostics: every splat adds 1 to the weight of each pixel that it lights, so weights are
 * counts, exact up to 2^24. */
void kernel_profile_count(struct kernel_profile *profile);

/* Squared radius of entry i. */
float kernel_profile_radius2(size_t i);

/* What the inner loop needs of a splat of radius > 0; `depths` must outlive it. */
struct kernel_splat kernel_prepare(const struct splat *splat, const struct kernel_profile *profile,
                                   const float *depths);

#endif
