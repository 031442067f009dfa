/* none.c: the indirect light stays as it is. */
#include <psplat/plugin.h>

static const ps_denoiser_vtable vtable = {.size = sizeof vtable};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_DENOISER,
    .name = "none",
    .version = "1.0",
    .summary = "leaves the indirect light as it is",
    .paper = "Hoet 2014, section 3.5: the blur is optional",
    .vtable = &vtable,
};

PS_MODULE(denoiser, none, &descriptor)
