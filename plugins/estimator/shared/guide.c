#include "guide.h"

#include <stdbool.h>
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

void guide_learn(struct guide *guide, ps_vec3 direction, float irradiance, float ratio)
{
    float cosine = ps_dot(direction, guide->normal);
    int ring, sector;
    if (!(cosine > 0.0f))
        return;
    bin_of(guide, direction, cosine, &ring, &sector);
    guide->found[ring][sector] += irradiance;
    guide->rays[ring][sector] += 1.0f / ratio;
}

/* --- smoothing --- */

/* Neighbours tell of a bin, too: what of ring `from`, and of a sector `away` from it, counts there. */
static float of_ring(int to, int from)
{
    bool is_border = to == 0 || to == GUIDE_RINGS - 1;
    return (to == from ? 0.5f : 0.25f) / (is_border ? 0.75f : 1.0f);
}

static float of_sector(int away)
{
    return away == 0 ? 0.5f : 0.25f;
}

static int first_ring(int ring)
{
    return ring > 0 ? ring - 1 : 0;
}

static int last_ring(int ring)
{
    return ring < GUIDE_RINGS - 1 ? ring + 1 : ring;
}

static float smoothed(float bins[GUIDE_RINGS][GUIDE_SECTORS], int ring, int sector)
{
    float sum = 0.0f;
    for (int from = first_ring(ring); from <= last_ring(ring); from++)
        for (int away = -1; away <= 1; away++) {
            int other = (sector + away + GUIDE_SECTORS) % GUIDE_SECTORS;
            sum += of_ring(ring, from) * of_sector(away) * bins[from][other];
        }
    return sum;
}

/* What of a bin is left in it, and in all bins together, when they are smoothed twice. */
static float left_in_bin(int ring)
{
    float of_rings = 0.0f, of_sectors = 0.25f * 0.25f + 0.5f * 0.5f + 0.25f * 0.25f;
    for (int other = first_ring(ring); other <= last_ring(ring); other++)
        of_rings += of_ring(ring, other) * of_ring(other, ring);
    return of_rings * of_sectors;
}

static float left_in_all(int ring)
{
    float left = 0.0f;
    for (int once = first_ring(ring); once <= last_ring(ring); once++)
        for (int twice = first_ring(once); twice <= last_ring(once); twice++)
            left += of_ring(twice, once) * of_ring(once, ring);
    return left;
}

void guide_update(struct guide *guide)
{
    guide->total = guide->smooth_total = 0.0f;
    for (int ring = 0; ring < GUIDE_RINGS; ring++) {
        float sectors = 0.0f;
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            guide->known[ring][sector] = smoothed(guide->found, ring, sector);
            sectors += guide->known[ring][sector];
            guide->sector_ends[ring][sector] = sectors;
        }
        guide->total += sectors;
        guide->ring_ends[ring] = guide->total;
    }
    for (int ring = 0; ring < GUIDE_RINGS; ring++)
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            guide->smooth[ring][sector] = smoothed(guide->known, ring, sector);
            guide->smooth_total += guide->smooth[ring][sector];
        }
    guide->ready = guide->total > 0.0f;
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

ps_vec3 guide_sample(const struct guide *guide, ps_vec3 normal, float a, float b)
{
    if (!guide->ready)
        return ps_cosine_direction(normal, a, b);
    if (a < BY_COSINE)
        return ps_cosine_direction(normal, a / BY_COSINE, b);
    return guided_direction(guide, (a - BY_COSINE) / (1.0f - BY_COSINE), b);
}

/* Where a direction lies in a guide; `slope` is its cosine with the guide's normal over that with a surface's. */
struct place {
    int ring, sector;
    float slope;
};

/* False where the guide does not reach: rays go there by the cosine alone. */
static bool find_place(const struct guide *guide, ps_vec3 normal, ps_vec3 direction,
                       struct place *place)
{
    float cosine = ps_dot(direction, normal), guided = ps_dot(direction, guide->normal);
    if (!(guided > 0.0f))
        return false;
    bin_of(guide, direction, guided, &place->ring, &place->sector);
    place->slope = guided / ps_max(cosine, 1e-6f);
    return true;
}

/* `share`: what of all light is in the bin. */
static float ratio_of(float share, float slope)
{
    return BY_COSINE + (1.0f - BY_COSINE) * share * (float)GUIDE_BINS * slope;
}

float guide_ratio(const struct guide *guide, ps_vec3 normal, ps_vec3 direction)
{
    struct place at;
    if (!guide->ready)
        return 1.0f;
    return find_place(guide, normal, direction, &at)
               ? ratio_of(guide->known[at.ring][at.sector] / guide->total, at.slope)
               : BY_COSINE;
}

/* By how much a bin has more light for that of one ray, than if that had found what the others did. */
static float excess(const struct guide *guide, const struct place *at, float learnt)
{
    float others = guide->rays[at->ring][at->sector] - 1.0f;
    float rest = guide->found[at->ring][at->sector] - learnt;
    return others > 0.5f ? learnt - rest / others : learnt;
}

float guide_smooth_ratio(const struct guide *guide, ps_vec3 normal, ps_vec3 direction, float learnt)
{
    struct place at;
    if (!guide->ready)
        return 1.0f;
    if (!find_place(guide, normal, direction, &at))
        return BY_COSINE;
    float more = learnt > 0.0f ? excess(guide, &at, learnt) : 0.0f;
    float total = guide->smooth_total - more * left_in_all(at.ring);
    if (!(total > 1e-6f * guide->smooth_total))
        return 1.0f; /* the guide knows of that ray alone */
    float in_bin = guide->smooth[at.ring][at.sector] - more * left_in_bin(at.ring);
    return ratio_of(ps_max(in_bin, 0.0f) / total, at.slope);
}
