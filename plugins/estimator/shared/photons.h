/* photons.h: the photons of a pass, batch by batch, and those of them that are chosen. */
#ifndef PSPLAT_ESTIMATOR_PHOTONS_H
#define PSPLAT_ESTIMATOR_PHOTONS_H

#include <psplat/plugin.h>
#include <stdbool.h>

/* Takes n > 0 photons. */
typedef ps_result (*photons_take)(void *user, const ps_photon *photons, size_t n);

/* Hands all photons of the pass on, in the order of emission, until one of the calls fails. Main
 * thread. */
static inline ps_result photons_for_each_batch(const ps_host *host, photons_take take, void *user)
{
    const ps_photon *photons;
    size_t n = 1;
    double progress;
    ps_result result = PS_OK;
    while (result == PS_OK && n > 0) {
        result = host->next_photons(host, &photons, &n, &progress);
        if (result == PS_OK && n > 0)
            result = take(user, photons, n);
    }
    return result;
}

typedef bool (*photons_belong)(const void *user, const ps_photon *photon);

/* Copies those of n photons that belong, with `scale` times their power; `chosen` is room for n.
 * Returns how many. */
static inline size_t photons_choose(const ps_photon *photons, size_t n, photons_belong belong,
                                    const void *user, float scale, ps_photon *chosen)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        if (!belong(user, &photons[i]))
            continue;
        chosen[count] = photons[i];
        chosen[count].power = ps_rgb_scale(photons[i].power, scale);
        count++;
    }
    return count;
}

typedef ps_result (*photons_splatter)(const ps_host *host, const ps_photon *photons, size_t n);

/* Splats those of n > 0 photons that belong, with `scale` times their power: by host->splat or
 * host->splat_points. Main thread. */
static inline ps_result photons_splat(const ps_host *host, photons_splatter splat,
                                      const ps_photon *photons, size_t n, photons_belong belong,
                                      const void *user, float scale)
{
    ps_photon *chosen = host->allocate(host, n * sizeof *chosen, "photons chosen");
    if (!chosen)
        return PS_ERROR_MEMORY;
    size_t count = photons_choose(photons, n, belong, user, scale, chosen);
    ps_result result = count > 0 ? splat(host, chosen, count) : PS_OK;
    host->release(host, chosen);
    return result;
}

#endif
