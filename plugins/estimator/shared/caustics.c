#include "caustics.h"

#include "photons.h"

static bool is_caustic(const void *user, const ps_photon *photon)
{
    (void)user;
    return photon->bounce == 0;
}

ps_result caustics_splat_photons(const ps_host *host, const ps_photon *photons, size_t n)
{
    ps_photon *chosen = host->allocate(host, n * sizeof *chosen, "photons chosen");
    if (!chosen)
        return PS_ERROR_MEMORY;
    size_t count = photons_choose(photons, n, is_caustic, NULL, 1.0f, chosen);
    ps_result result = count > 0 ? host->splat(host, chosen, count) : PS_OK;
    host->release(host, chosen);
    return result;
}

/* A photons_take. */
static ps_result splat_batch(void *opaque, const ps_photon *photons, size_t n)
{
    return caustics_splat_photons(opaque, photons, n);
}

ps_result caustics_splat(const ps_host *host)
{
    ps_result result = host->begin_splats(host, 0);
    return result == PS_OK ? photons_for_each_batch(host, splat_batch, (void *)host) : result;
}
