#include "guide.h"

#include <string.h>

_Static_assert(GUIDE_SECTORS == 16, "sector_of");

#define BY_COSINE 0.25f /* share of the rays */

void guide_begin(struct guide *guide, ps_vec3 normal)
{
    memset(guide, 0, sizeof *guide);
    guide->normal = normal;
    ps_frame(normal, &guide->u, &guide->v);
}

/* Sectors are found by comparisons: an eighth of the circle, and a half of that. */
static int sector_of(float x, float y)
{
    const float tangent = 0.41421356f; /* of 22.5 degrees */
    float ax = fabsf(x), ay = fabsf(y);
    int sector = ay > ax ? (ax < tangent * ay ? 3 : 2) : (ay > tangent * ax ? 1 : 0);
    if (x < 0.0f)
        sector = GUIDE_SECTORS / 2 - 1 - sector;
    return y < 0.0f ? GUIDE_SECTORS - 1 - sector : sector;
}

static void bin_of(const struct guide *guide, ps_vec3 direction, float cosine, int *ring,
                   int *sector)
{
    int r = (int)((1.0f - cosine * cosine) * GUIDE_RINGS);
    *ring = r < 0 ? 0 : r < GUIDE_RINGS ? r : GUIDE_RINGS - 1;
    *sector = sector_of(ps_dot(direction, guide->u), ps_dot(direction, guide->v));
}

void guide_learn(struct guide *guide, ps_vec3 direction, float irradiance)
{
    float cosine = ps_dot(direction, guide->normal);
    int ring, sector;
    if (!(cosine > 0.0f))
        return;
    bin_of(guide, direction, cosine, &ring, &sector);
    guide->found[ring][sector] += irradiance;
}

/* Neighbours tell of a bin, too. */
static float smoothed(const struct guide *guide, int ring, int sector)
{
    static const float weights[3] = {0.25f, 0.5f, 0.25f};
    float sum = 0.0f, total = 0.0f;
    for (int i = -1; i <= 1; i++) {
        if (ring + i < 0 || ring + i >= GUIDE_RINGS)
            continue;
        for (int j = -1; j <= 1; j++) {
            int other = (sector + j + GUIDE_SECTORS) % GUIDE_SECTORS;
            float weight = weights[i + 1] * weights[j + 1];
            sum += weight * guide->found[ring + i][other];
            total += weight;
        }
    }
    return sum / total;
}

void guide_update(struct guide *guide)
{
    float sum = 0.0f;
    for (int ring = 0; ring < GUIDE_RINGS; ring++)
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            guide->density[ring][sector] = smoothed(guide, ring, sector);
            sum += guide->density[ring][sector];
        }
    guide->ready = sum > 0.0f;
    if (!guide->ready)
        return;
    float rings = 0.0f;
    for (int ring = 0; ring < GUIDE_RINGS; ring++) {
        float sectors = 0.0f;
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            sectors += guide->density[ring][sector];
            guide->sector_ends[ring][sector] = sectors;
            guide->density[ring][sector] *= (float)GUIDE_BINS / sum;
        }
        rings += sectors;
        guide->ring_ends[ring] = rings;
    }
}

/* Which of n cumulative ends a number of [0, 1) falls before, and where in its part. */
static int choose(const float *ends, int n, float number, float *within)
{
    float at = number * ends[n - 1], before = 0.0f;
    int i = 0;
    while (i < n - 1 && at >= ends[i])
        before = ends[i++];
    float part = ends[i] - before;
    *within = part > 0.0f ? ps_min((at - before) / part, 0.999999f) : 0.5f;
    return i;
}

static ps_vec3 guided_direction(const struct guide *guide, float a, float b)
{
    float in_ring, in_sector;
    int ring = choose(guide->ring_ends, GUIDE_RINGS, a, &in_ring);
    int sector = choose(guide->sector_ends[ring], GUIDE_SECTORS, b, &in_sector);
    return ps_cosine_direction(guide->normal, ((float)ring + in_ring) / GUIDE_RINGS,
                               ((float)sector + in_sector) / GUIDE_SECTORS);
}

static float guided_pdf(const struct guide *guide, ps_vec3 direction)
{
    float cosine = ps_dot(direction, guide->normal);
    int ring, sector;
    if (!(cosine > 0.0f))
        return 0.0f;
    bin_of(guide, direction, cosine, &ring, &sector);
    return guide->density[ring][sector] * cosine / PS_PI;
}

ps_vec3 guide_sample(const struct guide *guide, ps_vec3 normal, float a, float b, float *pdf)
{
    ps_vec3 direction;
    if (!guide->ready) {
        direction = ps_cosine_direction(normal, a, b);
        *pdf = ps_max(ps_dot(direction, normal), 1e-6f) / PS_PI;
        return direction;
    }
    if (a < BY_COSINE)
        direction = ps_cosine_direction(normal, a / BY_COSINE, b);
    else
        direction = guided_direction(guide, (a - BY_COSINE) / (1.0f - BY_COSINE), b);
    float cosine = ps_max(ps_dot(direction, normal), 0.0f);
    *pdf = BY_COSINE * cosine / PS_PI + (1.0f - BY_COSINE) * guided_pdf(guide, direction);
    return direction;
}
