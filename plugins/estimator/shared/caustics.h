/* caustics.h: light that comes from lamps by mirrors, glass and gloss alone, which changes too fast for what estimators
 * interpolate: its photons are splatted onto the pixels, by the visibility and filter chosen.
 */
#ifndef PSPLAT_ESTIMATOR_CAUSTICS_H
#define PSPLAT_ESTIMATOR_CAUSTICS_H

#include "photons.h"

static inline bool caustics_belong(const void *user, const ps_photon *photon)
{
    (void)user;
    return photon->bounce == 0;
}

/* Splats those of n photons that are caustics. After begin_splats; main thread. */
static inline ps_result caustics_splat(const ps_host *host, const ps_photon *photons, size_t n)
{
    ps_photon *chosen = host->allocate(host, n * sizeof *chosen, "photons chosen");
    if (!chosen)
        return PS_ERROR_MEMORY;
    size_t count = photons_choose(photons, n, caustics_belong, NULL, 1.0f, chosen);
    ps_result result = count > 0 ? host->splat(host, chosen, count) : PS_OK;
    host->release(host, chosen);
    return result;
}

#endif
