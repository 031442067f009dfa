/* path.h: how random walks go on and end. Russian roulette: Arvo and Kirk 1990. */
#ifndef PSPLAT_PATH_H
#define PSPLAT_PATH_H

#include <psplat/host.h>
#include <psplat/math.h>

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

/* Traces n rays, and moves those that meet something to the front, with their hits; returns how
 * many. kept[i] >= i becomes the place that number i came from. Any thread. */
static inline size_t ps_trace_kept(const ps_host *host, ps_ray *rays, size_t n, ps_hit *hits,
                                   size_t *kept)
{
    size_t met = 0;
    host->intersect(host, rays, n, hits);
    for (size_t i = 0; i < n; i++) {
        if (!(hits[i].distance < INFINITY))
            continue;
        kept[met] = i;
        rays[met] = rays[i];
        hits[met++] = hits[i];
    }
    return met;
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
