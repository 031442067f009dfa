/* weights.h: what pixels count for a fit (fit.h), a run of LANES at a time.
 *
 * These loops are to be inlined into functions that are PS_EVERY_ISA.
 */
#ifndef PSPLAT_DENOISER_REGRESSION_WEIGHTS_H
#define PSPLAT_DENOISER_REGRESSION_WEIGHTS_H

#include "bounds.h"
#include "fit.h"

#include <psplat/isa.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { LANES = REGRESSION_LANES };

#define MOST_GLOSS 0.25f /* G */

/* A plane for each value, a + b u + c v, borrowed. */
struct regression_fit {
    float normal[3], position[3], u[3], v[3]; /* the tangent plane; u and v are over R */
    float height_scale, bend_scale;           /* 1 / D^2, 1 / (1 - cos(normal)) */
    float gloss;
    float weight;      /* of its pixels */
    float (*plane)[3]; /* of each value */
    int x, y;
    bool valid; /* its centre shows a surface */
};

static inline int larger(int a, int b)
{
    return a > b ? a : b;
}

static inline int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* max(s, 0) without a comparison, which keeps compilers from making vectors. */
static PS_INLINED float above_zero(float s)
{
    return 0.5f * (s + fabsf(s));
}

/* Whether its bounds tell that no pixel of a run has any weight. */
static PS_INLINED bool are_unlike(const struct regression *to, const struct regression_fit *fit,
                                  size_t run)
{
    const struct regression_bounds *of = &to->bounds[run];
    float cosine = 0.0f, height = 0.0f, extent = 0.0f;
    for (int i = 0; i < 3; i++) {
        float n = fit->normal[i];
        cosine += n * of->normal[i] + fabsf(n) * of->normal_extent[i];
        height += n * (of->position[i] - fit->position[i]);
        extent += fabsf(n) * of->position_extent[i];
    }
    float over = above_zero(fabsf(height) - extent);
    float other = above_zero(fabsf(of->gloss - fit->gloss) - of->gloss_extent);
    other *= 1.0f / MOST_GLOSS;
    return (1.0f - cosine) * fit->bend_scale >= 1.0f ||
           over * over * fit->height_scale + other * other >= 1.0f;
}

/* Of numbers that are not negative: by their bits, which compilers make vectors of. */
static PS_INLINED bool all_zero(const float weight[LANES])
{
    uint32_t bits[LANES], any = 0;
    memcpy(bits, weight, sizeof bits);
#pragma omp simd reduction(| : any)
    for (int i = 0; i < LANES; i++)
        any |= bits[i];
    return any == 0;
}

/* Their weights by geometry. */
static PS_INLINED void weigh(const struct regression *to, const struct regression_fit *fit,
                             size_t from, float *restrict weight)
{
    const float *restrict nx = to->normal[0] + from, *restrict px = to->position[0] + from;
    const float *restrict ny = to->normal[1] + from, *restrict py = to->position[1] + from;
    const float *restrict nz = to->normal[2] + from, *restrict pz = to->position[2] + from;
    const float *restrict gloss = to->gloss + from;
    float bend_scale = fit->bend_scale, height_scale = fit->height_scale;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float dx = px[i] - fit->position[0];
        float dy = py[i] - fit->position[1];
        float dz = pz[i] - fit->position[2];
        float cosine = nx[i] * fit->normal[0] + ny[i] * fit->normal[1] + nz[i] * fit->normal[2];
        float over = dx * fit->normal[0] + dy * fit->normal[1] + dz * fit->normal[2];
        float under = dx * nx[i] + dy * ny[i] + dz * nz[i];
        float bend = above_zero(1.0f - (1.0f - cosine) * bend_scale);
        float other = (gloss[i] - fit->gloss) * (1.0f / MOST_GLOSS);
        float like =
            above_zero(1.0f - (over * over + under * under) * height_scale - other * other);
        weight[i] = bend * bend * like * like;
    }
}

/* Their places in the tangent plane. */
static PS_INLINED void locate(const struct regression *to, const struct regression_fit *fit,
                              size_t from, float *restrict u, float *restrict v)
{
    const float *restrict px = to->position[0] + from, *restrict py = to->position[1] + from,
                          *restrict pz = to->position[2] + from;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float dx = px[i] - fit->position[0];
        float dy = py[i] - fit->position[1];
        float dz = pz[i] - fit->position[2];
        u[i] = dx * fit->u[0] + dy * fit->u[1] + dz * fit->u[2];
        v[i] = dx * fit->v[0] + dy * fit->v[1] + dz * fit->v[2];
    }
}

/* All of that. False: none of the pixels has any weight, and the rest is not set. */
static PS_INLINED bool take_pixels(const struct regression *to, const struct regression_fit *fit,
                                   size_t run, float *restrict weight, float *restrict u,
                                   float *restrict v)
{
    size_t from = run * to->runs_apart;
    if (are_unlike(to, fit, run))
        return false;
    weigh(to, fit, from, weight);
    if (all_zero(weight))
        return false;
    locate(to, fit, from, u, v);
    return true;
}

#endif
