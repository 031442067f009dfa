/* none.c: every photon stays what it is. */
#include <psplat/plugin.h>

static const ps_stratification_vtable vtable = {.size = sizeof vtable};

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
