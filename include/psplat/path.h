/* path.h: how random walks go on and end. Russian roulette: Arvo and Kirk 1990. */
#ifndef PSPLAT_PATH_H
#define PSPLAT_PATH_H

#include <psplat/host.h>
#include <psplat/math.h>
#include <stdbool.h>

/* Mirrors and glass that a path may meet between two diffuse surfaces; between facing mirrors it
 * would run for ever. */
#define PS_LONGEST_CHAIN 32

/* An albedo near 1 would keep a path alive for ever. */
#define PS_LIKELIEST_SURVIVAL 0.98f

/* Lets a path go on with the given probability (capped), decided by `number` in [0, 1): returns 0
 * where it ends, and otherwise divides what it carries by the probability, which keeps the mean. */
static inline int ps_russian_roulette(float probability, float number, ps_rgb *carried)
{
    float survival = ps_min(probability, PS_LIKELIEST_SURVIVAL);
    if (number >= survival)
        return 0;
    *carried = ps_rgb_scale(*carried, 1.0f / survival);
    return 1;
}

/* Ray cones (Amanatides 1984, "Ray tracing with cones"): a ray drawn with density p (1/sr) stands
 * for a cone of solid angle 1 / (PS_CONES p). More cones would look up textures texel by texel,
 * fewer would mix light of different colours. */
#define PS_CONES 800.0f
#define PS_WIDEST_CONE 0.125f

/* For intersect_cones: the width of the cone of a direction drawn with density `pdf` (1/sr), over
 * the distance. A pdf of 0, a mirror's, gives 0: a ray without width. */
static inline float ps_cone_spread(float pdf)
{
    return pdf > 0.0f ? ps_min(sqrtf(1.0f / (PS_CONES * pdf)), PS_WIDEST_CONE) : 0.0f;
}

/* A ps_gloss after one more surface, of that ps_hit.roughness, that has not scattered a path
 * diffusely. */
static inline uint8_t ps_gloss_after(uint8_t before, float roughness)
{
    bool is_rough = before != PS_SHARP_GLOSS && roughness >= PS_ROUGH_GLOSS;
    return is_rough ? PS_ONLY_ROUGH_GLOSS : PS_SHARP_GLOSS;
}

/* The spread of a diffuse bounce, at its typical density 1 / pi: sqrt(pi / PS_CONES). */
#define PS_DIFFUSE_SPREAD 0.0627f

/* Moves those of n rays that met something to the front, with their hits; returns how many. kept[i]
 * >= i becomes the place that number i came from. */
static inline size_t ps_keep_hits(ps_ray *rays, size_t n, ps_hit *hits, size_t *kept)
{
    size_t met = 0;
    for (size_t i = 0; i < n; i++) {
        if (!(hits[i].distance < INFINITY))
            continue;
        kept[met] = i;
        rays[met] = rays[i];
        hits[met++] = hits[i];
    }
    return met;
}

/* Traces n rays, and keeps those that meet something, as ps_keep_hits. Any thread. */
static inline size_t ps_trace_kept(const ps_host *host, ps_ray *rays, size_t n, ps_hit *hits,
                                   size_t *kept)
{
    host->intersect(host, rays, n, hits);
    return ps_keep_hits(rays, n, hits, kept);
}

/* For an injection whose photons lie where lights shine, in prepare: says, once a render, that
 * there is light of one bounce alone where more is asked for. */
static inline void ps_warn_of_single_bounce(const ps_host *host, const ps_pass *pass,
                                            const char *warning)
{
    if (pass->number == 0 && pass->bounces > 1)
        host->log(host, PS_LOG_WARNING, warning);
}

#endif
