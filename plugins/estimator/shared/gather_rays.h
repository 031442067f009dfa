/* gather_rays.h: the final gather of a group of points: the pixels of a tile, or surfels.
 *
 * Paths leave the points (paths.h) and go on until a cache of irradiance knows the rest, or to
 * their end. Their first directions are drawn where those before them found light (guide.h).
 *
 * The first round's rays, c of them with the cosine's density, or where light is concentrated half
 * by that and half by what photons say (photon_guide.h), p, are noisier than the g guided ones.
 * Both are combined by the balance heuristic (Veach and Guibas 1995), with a density q:
 *
 *     w_first = c p / (c p + g q),   w_guided = g q / (c p + g q)
 *
 * For each direction the weights add up to 1 whatever q is, so q may be smoother than the density
 * that was sampled (guide_smooth_ratio()). Where there are guides of several rounds, this is done
 * with each, and the mean over all guided rays is taken.
 *
 * Neither q nor g may depend on the rays that they weigh, or bright rays count for too little. So
 * the points of a group are two halves, and each half is weighed by the guide and the number of
 * samples that the other half and the groups around give (cross-fitting).
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_RAYS_H
#define PSPLAT_ESTIMATOR_GATHER_RAYS_H

#include "guide.h"

#include "paths.h"
#include "photon_guide.h"
#include "sample_factors.h"

/* Guides of a group, one for each way that its surfaces face. */
enum { GATHER_GUIDES = 4 };

/* Samples of the first round, after which rays are guided, at most; and how many of so many in all
 * are best. */
enum { GATHER_MOST_FIRST = 4 };
uint64_t gather_first_of(uint64_t samples);

/* What a cache has of the irradiance where a ray landed, W/m^2. */
struct cached_irradiance {
    /* Of light that met other surfaces before; 0 but with setting->cache_has_indirect. */
    ps_rgb indirect;
    /* Of light of PS_LIGHTS_SOFT that met none; 0 but with setting->cache_has_sky. */
    ps_rgb sky;
};

/* Where a ray landed. */
struct gather_landing {
    ps_vec3 position, normal;
    uint32_t material;
    float length;     /* of its way since a diffuse surface */
    bool is_focused;  /* perhaps: it came by mirrors, glass or gloss */
    float numbers[2]; /* random ones, of [0, 1) */
    uint32_t path;    /* whose ray it is: known[path] is what the cache knows */
};

/* Looks up what the cache knows for up to PS_TILE_PIXELS landings, and sets is_known[path] where it
 * does. It was false, and stays so where the cache knows nothing or the way is too short for it:
 * the path goes on. Any thread. */
typedef void (*gather_lookup)(const void *cache, const struct gather_landing *landings, size_t n,
                              struct cached_irradiance *known, bool *is_known);

struct gather_setting {
    struct paths_setting paths;
    uint64_t samples;     /* from each point, in the mean over groups */
    uint64_t first;       /* of the first round, at most GATHER_MOST_FIRST */
    uint64_t most;        /* from a point whose factor is 1: random numbers are counted by it */
    gather_lookup lookup; /* NULL: there is no cache, and paths go on to their ends */
    const void *cache;
    bool cache_has_indirect; /* paths end there */
    bool cache_has_sky;      /* light of PS_LIGHTS_SOFT: paths sample only the other lights there */
    const struct photon_guide *photons; /* by which first rays are guided; NULL: by the cosine */
    double share_before; /* of a pass's time, which what comes before the picture takes */
};

/* What the rays of the first round found, and where: to be weighed when there are
 * guides. And the guides' histograms of that (gather_keep_first_round()). */
struct gather_first {
    /* Factors on the number of guided samples of each point (sample_factors.h): set by
     * gather_begin() to 1. */
    float factors[PS_TILE_PIXELS];
    float nearest[PS_TILE_PIXELS]; /* least distance that a point's rays went (contact.h) */
    bool is_guided;                /* by photons, at some points */
    ps_rgb found[GATHER_MOST_FIRST][PS_TILE_PIXELS];
    struct guide_bin bins[GATHER_MOST_FIRST][PS_TILE_PIXELS];
    uint32_t guide_count;
    struct guide_histogram histograms[GATHER_GUIDES];
};

struct gather {
    const struct gather_setting *setting;
    uint64_t index; /* of the group, among all that draw random numbers: a tile's own */
    ps_points points;
    uint64_t done; /* samples, of a point that has most */
    /* Samples in all by which rays of either half are weighed: set by gather_begin() to the
     * mean. */
    uint64_t expected_samples[2];
    /* Estimates of the irradiance, W/m^2, at each point, when all samples are done; `half` is what
     * the first half of each round has of it. */
    ps_rgb irradiance[PS_TILE_PIXELS], half[PS_TILE_PIXELS];
    struct gather_first first;
    /* Sums over the guided rays of the squares of what each adds to the mean of the irradiance's
     * channels; and what the rays of the first round are weighed with. */
    float squares[PS_TILE_PIXELS], first_weights[GATHER_MOST_FIRST][PS_TILE_PIXELS];
    /* Of the round under way, for each point: its samples, and the index of the first. */
    uint64_t taken[PS_TILE_PIXELS], starts[PS_TILE_PIXELS];
    /* What one of a point's guided samples is of all, and how many of them rays of its half are
     * weighed by. */
    float guided_share[PS_TILE_PIXELS], guided_expected[PS_TILE_PIXELS];
    uint8_t guide_of[PS_TILE_PIXELS];
    uint32_t guide_count;
    bool is_bent[GATHER_GUIDES]; /* points of a guide face different ways */
    struct guide guides[GATHER_GUIDES];
    struct guide first_guides[GATHER_GUIDES]; /* of the first round, where first.is_guided */
};

/* Which half of the group a point is of, 0 or 1: of the curve, along which samples are
 * stratified. */
int gather_half_of(const struct gather *gather, size_t point);

/* Chooses guides, when setting, index and points are given and the rest is 0. */
void gather_begin(struct gather *gather);

/* Takes samples in rounds, until `samples` are done of a point whose factor is 1. Any thread. */
void gather_samples(struct gather *gather, uint64_t samples);

/* The variance of the mean of a point's channels of the irradiance, by what its rays found, after
 * `samples`, which are more than setting->first. Rays are stratified, so that it is rather less. It
 * tells nothing of light that no ray found. */
float gather_variance(const struct gather *gather, size_t point, uint64_t samples);

/* After a first round that no other follows for now: adds it to the guides, and keeps their
 * histograms in gather->first. */
void gather_keep_first_round(struct gather *gather);

/* Goes on after the first round of a gather of the same points, which was kept; more samples are to
 * follow, by first->factors. They are also guided by what those of `count` gathers around found. */
void gather_resume(struct gather *gather, const struct gather_first *first,
                   const struct gather_first *const around[], size_t count);

#endif
