#include "guide.h"

#include <stdbool.h>
#include <string.h>

_Static_assert(GUIDE_SECTORS == 16, "sector_of");

#define BY_COSINE 0.25f       /* share of the rays */
#define COARSE_BY_COSINE 0.5f /* least share of those of a coarse guide */
#define SPREAD 4.5f           /* concentration up to which the cosine does better than that */
#define LEAST_LIGHT 1e-30f    /* or a guide knows of none: W/m^2 */
#define SAME_FRAME 0.99f      /* cosine between axes */
#define SIMILAR_FACING 0.7f   /* cosine between normals of guides that tell each other */

void guide_begin(struct guide *guide, ps_vec3 normal)
{
    memset(guide, 0, sizeof *guide);
    guide->normal = normal;
    guide->by_cosine = BY_COSINE;
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

/* A direction's cosine to the guide's normal, over that to the surface's. */
static float tilt_of(const struct guide *guide, ps_vec3 normal, ps_vec3 direction)
{
    if (ps_same(normal, guide->normal))
        return 1.0f;
    return ps_dot(direction, guide->normal) / ps_max(ps_dot(direction, normal), 1e-6f);
}

struct guide_bin guide_bin_of(const struct guide *guide, ps_vec3 normal, ps_vec3 direction)
{
    float guided = ps_dot(direction, guide->normal);
    if (!(guided > 0.0f))
        return (struct guide_bin){NO_GUIDE_BIN, 0.0f};
    int ring = (int)((1.0f - guided * guided) * GUIDE_RINGS);
    ring = ring < 0 ? 0 : ring < GUIDE_RINGS ? ring : GUIDE_RINGS - 1;
    int sector = sector_of(ps_dot(direction, guide->u), ps_dot(direction, guide->v));
    return (struct guide_bin){ring * GUIDE_SECTORS + sector, tilt_of(guide, normal, direction)};
}

void guide_add(struct guide *guide, int half, struct guide_bin bin, float irradiance)
{
    if (bin.index != NO_GUIDE_BIN)
        guide->found[half][bin.index / GUIDE_SECTORS][bin.index % GUIDE_SECTORS] += irradiance;
}

static void add_to_both(struct guide *guide, struct guide_bin bin, float irradiance)
{
    guide_add(guide, 0, bin, irradiance);
    guide_add(guide, 1, bin, irradiance);
}

/* The bin where the middle of one of another guide's lies, and `found` as the cosine to this one's
 * normal has it. */
static struct guide_bin bin_from(const struct guide *guide, ps_vec3 normal, int ring, int sector,
                                 float *found)
{
    ps_vec3 direction = ps_cosine_direction(normal, ((float)ring + 0.5f) / GUIDE_RINGS,
                                            ((float)sector + 0.5f) / GUIDE_SECTORS);
    *found *= ps_dot(direction, guide->normal) / ps_dot(direction, normal);
    return guide_bin_of(guide, guide->normal, direction);
}

void guide_add_histogram(struct guide *guide, const struct guide_histogram *histogram, float share)
{
    float facing = ps_dot(guide->normal, histogram->normal);
    ps_vec3 u, v;
    ps_frame(histogram->normal, &u, &v);
    bool has_frame = facing > SAME_FRAME && ps_dot(guide->u, u) > SAME_FRAME;
    if (!(facing > SIMILAR_FACING))
        return;
    for (int ring = 0; ring < GUIDE_RINGS; ring++)
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            struct guide_bin bin = {ring * GUIDE_SECTORS + sector, 1.0f};
            float found = 0.5f * share *
                          (histogram->found[0][ring][sector] + histogram->found[1][ring][sector]);
            if (found > 0.0f && !has_frame)
                bin = bin_from(guide, histogram->normal, ring, sector, &found);
            add_to_both(guide, bin, found);
        }
}

/* --- smoothing --- */

/* Neighbours tell of a bin, too: half of what it gets is its own, and a quarter comes from either
 * side, along its ring, then across the rings, where the first and the last have one neighbour.
 * Returns the sum of all bins. */
static float smooth(guide_bins from, guide_bins to)
{
    const int last = GUIDE_RINGS - 1;
    guide_bins along;
    float sum = 0.0f;
    for (int ring = 0; ring < GUIDE_RINGS; ring++)
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            float before = from[ring][(sector + GUIDE_SECTORS - 1) % GUIDE_SECTORS];
            float after = from[ring][(sector + 1) % GUIDE_SECTORS];
            along[ring][sector] = 0.5f * from[ring][sector] + 0.25f * (before + after);
        }
    for (int ring = 0; ring < GUIDE_RINGS; ring++)
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            float own = 0.5f * along[ring][sector];
            float below = ring > 0 ? 0.25f * along[ring - 1][sector] : 0.0f;
            float above = ring < last ? 0.25f * along[ring + 1][sector] : 0.0f;
            float whole = ring > 0 && ring < last ? 1.0f : 0.75f;
            to[ring][sector] = (own + below + above) / whole;
            sum += to[ring][sector];
        }
    return sum;
}

/* The factor by which the light of a bin becomes a density over that of the cosine; `total`: of all
 * bins. */
static float scale_of(const struct guide *guide, float total)
{
    return total > LEAST_LIGHT ? (1.0f - guide->by_cosine) * (float)GUIDE_BINS / total : 0.0f;
}

static void smooth_halves(struct guide *guide, guide_bins once[2])
{
    for (int half = 0; half < 2; half++)
        smooth(guide->found[half], once[half]);
}

static void update(struct guide *guide, guide_bins once[2])
{
    float total = 0.0f;
    for (int half = 0; half < 2; half++)
        guide->smooth_scale[half] = scale_of(guide, smooth(once[half], guide->smooth[half]));
    for (int ring = 0; ring < GUIDE_RINGS; ring++) {
        float sectors = 0.0f;
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            guide->known[ring][sector] = once[0][ring][sector] + once[1][ring][sector];
            sectors += guide->known[ring][sector];
            guide->sector_ends[ring][sector] = sectors;
        }
        total += sectors;
        guide->ring_ends[ring] = total;
    }
    guide->scale = scale_of(guide, total);
}

void guide_update(struct guide *guide)
{
    guide_bins once[2];
    smooth_halves(guide, once);
    update(guide, once);
}

/* The second moment of the light of a ray that the cosine draws, over the square of the mean: 1 if
 * light comes evenly. From two independent estimates of the light, or their noise would count. */
static float concentration(guide_bins a, guide_bins b)
{
    float sum_a = 0.0f, sum_b = 0.0f, products = 0.0f;
    for (int ring = 0; ring < GUIDE_RINGS; ring++)
        for (int sector = 0; sector < GUIDE_SECTORS; sector++) {
            sum_a += a[ring][sector];
            sum_b += b[ring][sector];
            products += a[ring][sector] * b[ring][sector];
        }
    return sum_a > LEAST_LIGHT && sum_b > LEAST_LIGHT ? (float)GUIDE_BINS * products / sum_a / sum_b
                                                      : 0.0f;
}

void guide_update_coarse(struct guide *guide)
{
    guide_bins once[2];
    smooth_halves(guide, once);
    float concentrated = concentration(once[0], once[1]);
    guide->by_cosine =
        concentrated > SPREAD ? ps_max(SPREAD / concentrated, COARSE_BY_COSINE) : 1.0f;
    update(guide, once);
}

/* --- directions --- */

/* Inverts a cumulative distribution over n bins at a number of [0, 1). In bins: 2.25 is a quarter
 * into the third one. */
static inline float invert(const float *ends, int n, float number)
{
    float at = number * ends[n - 1];
    int i = 0;
    for (int k = 0; k < n; k++) /* without a branch that depends on the number */
        i += at >= ends[k];
    i = i < n ? i : n - 1;
    float before = i > 0 ? ends[i - 1] : 0.0f;
    float part = ends[i] - before;
    return (float)i + (part > 0.0f ? ps_min((at - before) / part, 0.999998f) : 0.5f);
}

/* Cosine and sine of the middles of the sectors. */
static const float middles[GUIDE_SECTORS][2] = {
    {0.980785280f, 0.195090322f},   {0.831469612f, 0.555570233f},   {0.555570233f, 0.831469612f},
    {0.195090322f, 0.980785280f},   {-0.195090322f, 0.980785280f},  {-0.555570233f, 0.831469612f},
    {-0.831469612f, 0.555570233f},  {-0.980785280f, 0.195090322f},  {-0.980785280f, -0.195090322f},
    {-0.831469612f, -0.555570233f}, {-0.555570233f, -0.831469612f}, {-0.195090322f, -0.980785280f},
    {0.195090322f, -0.980785280f},  {0.555570233f, -0.831469612f},  {0.831469612f, -0.555570233f},
    {0.980785280f, -0.195090322f},
};

struct on_circle {
    float cosine, sine;
};

/* At a position in sectors: by the middle of its sector and the rest of the way, at most 0.2, for
 * which Taylor's polynomials are exact to rounding. sincosf would be slower. */
static inline struct on_circle on_circle_at(float sector)
{
    const float *middle = middles[(int)sector];
    float x = (sector - (float)(int)sector - 0.5f) * (2.0f * PS_PI / GUIDE_SECTORS), x2 = x * x;
    float sine = x * (1.0f - x2 * (1.0f / 6.0f) * (1.0f - x2 * (1.0f / 20.0f)));
    float cosine = 1.0f - x2 * 0.5f * (1.0f - x2 * (1.0f / 12.0f) * (1.0f - x2 * (1.0f / 30.0f)));
    return (struct on_circle){middle[0] * cosine - middle[1] * sine,
                              middle[1] * cosine + middle[0] * sine};
}

/* The direction at a position in the histogram, in bins: ps_cosine_direction() by the guide's
 * frame. */
static inline struct guide_sample direction_at(const struct guide *guide, float ring, float sector)
{
    struct on_circle around = on_circle_at(sector);
    float sine2 = ring / GUIDE_RINGS;
    float sine = sqrtf(sine2), cosine = sqrtf(ps_max(1.0f - sine2, 0.0f));
    ps_vec3 in_plane =
        ps_add_scaled(ps_scale(guide->u, sine * around.cosine), sine * around.sine, guide->v);
    return (struct guide_sample){ps_add_scaled(in_plane, cosine, guide->normal),
                                 {(int32_t)ring * GUIDE_SECTORS + (int32_t)sector, 1.0f},
                                 1.0f};
}

static float ratio_of(const struct guide *guide, const float (*light)[GUIDE_SECTORS], float scale,
                      struct guide_bin bin)
{
    if (!(scale > 0.0f))
        return 1.0f;
    if (bin.index == NO_GUIDE_BIN) /* rays go there by the cosine alone */
        return guide->by_cosine;
    return guide->by_cosine +
           scale * light[bin.index / GUIDE_SECTORS][bin.index % GUIDE_SECTORS] * bin.tilt;
}

float guide_ratio(const struct guide *guide, struct guide_bin bin)
{
    return ratio_of(guide, guide->known, guide->scale, bin);
}

float guide_smooth_ratio(const struct guide *guide, int half, struct guide_bin bin)
{
    return ratio_of(guide, guide->smooth[1 - half], guide->smooth_scale[1 - half], bin);
}

static struct guide_sample by_cosine(const struct guide *guide, ps_vec3 normal, float a, float b)
{
    if (ps_same(normal, guide->normal))
        return direction_at(guide, a * GUIDE_RINGS, b * GUIDE_SECTORS);
    ps_vec3 direction = ps_cosine_direction(normal, a, b);
    return (struct guide_sample){direction, guide_bin_of(guide, normal, direction), 1.0f};
}

static struct guide_sample by_light(const struct guide *guide, ps_vec3 normal, float a, float b)
{
    float ring = invert(guide->ring_ends, GUIDE_RINGS, a);
    float sector = invert(guide->sector_ends[(int)ring], GUIDE_SECTORS, b);
    struct guide_sample sample = direction_at(guide, ring, sector);
    sample.bin.tilt = tilt_of(guide, normal, sample.direction);
    return sample;
}

struct guide_sample guide_sample(const struct guide *guide, ps_vec3 normal, float a, float b)
{
    if (!(guide->scale > 0.0f))
        return by_cosine(guide, normal, a, b);
    float share = guide->by_cosine;
    struct guide_sample sample = a < share
                                     ? by_cosine(guide, normal, a / share, b)
                                     : by_light(guide, normal, (a - share) / (1.0f - share), b);
    sample.ratio = guide_ratio(guide, sample.bin);
    return sample;
}
