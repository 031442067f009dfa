#include "caustics.h"

#include "photons.h"

static bool is_caustic(const void *user, const ps_photon *photon)
{
    (void)user;
    return photon->bounce == 0;
}

ps_result caustics_splat_photons(const ps_host *host, const ps_photon *photons, size_t n)
{
    return photons_splat(host, host->splat, photons, n, is_caustic, NULL, 1.0f);
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
