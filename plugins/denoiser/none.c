/* none.c: the indirect light stays as it is. */
#include <psplat/plugin.h>

static ps_result filter(const void *state, const ps_host *host, const ps_image_view *image)
{
    (void)state;
    (void)host;
    (void)image;
    return PS_OK;
}

static const ps_denoiser_vtable vtable = {
    .size = sizeof vtable,
    .keeps_all = 1,
    .filter = filter,
};

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
