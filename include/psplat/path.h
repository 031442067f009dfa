/* path.h: how random walks go on and end. Russian roulette: Arvo and Kirk 1990. */
#ifndef PSPLAT_PATH_H
#define PSPLAT_PATH_H

#include <psplat/host.h>
#include <psplat/math.h>
#include <stdio.h>

/* Mirrors and glass that a path may meet between two diffuse surfaces; between facing mirrors it would
 * run for ever. */
#define PS_LONGEST_CHAIN 32

/* An albedo near 1 would keep a path alive for ever. */
#define PS_LIKELIEST_SURVIVAL 0.98f

/* Lets a path go on with the given probability (capped), decided by `number` in [0, 1): returns 0
 * where it ends, and otherwise divides what it carries by the probability, which keeps the mean. */
static inline int ps_survives(float probability, float number, ps_rgb *carried)
{
    float survival = ps_min(probability, PS_LIKELIEST_SURVIVAL);
    if (number >= survival)
        return 0;
    *carried = ps_rgb_scale(*carried, 1.0f / survival);
    return 1;
}

/* Traces n rays, and moves those that meet something to the front, with their hits; returns how many.
 * kept[i] >= i becomes the place that number i came from. Any thread. */
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

/* For init: bounces without a limit (0) end only by roulette (0: never). Non-zero, and a message, if
 * nothing ends them. */
static inline int32_t ps_check_bounces(int64_t bounces, int64_t roulette, char *message,
                                       size_t message_size)
{
    if (bounces != 0 || roulette != 0)
        return 0;
    snprintf(message, message_size,
             "unlimited bounces (bounces=0) need Russian roulette (roulette > 0)");
    return 1;
}

#endif
