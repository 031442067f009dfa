/* none.c: every photon stays what it is. */
#include <psplat/plugin.h>

static ps_result combine(const void *state, const ps_host *host, const ps_pass *pass,
                         ps_photon *photons, size_t *n)
{
    (void)state;
    (void)host;
    (void)pass;
    (void)photons;
    (void)n;
    return PS_OK;
}

static const ps_stratification_vtable vtable = {
    .size = sizeof vtable,
    .combine = combine,
    .keeps_all = 1,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_STRATIFICATION,
    .name = "none",
    .version = "1.0",
    .summary = "keeps every photon as it was injected",
    .paper = "Hoet 2014, section 3.2: stratification is optional",
    .vtable = &vtable,
};

PS_MODULE(stratification, none, &descriptor)
