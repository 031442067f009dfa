/* none.c: no visibility: everything inside a splat's box that faces the light is lit.
 *
 * What splatting would be if the visibility term were left out, as by Dachsbacher and Stamminger
 * 2006: light leaks behind whatever the central ray misses. Good for seeing what a shadow map is
 * worth. The reach of the box (`depth`) decides how far light leaks.
 */
#include <psplat/plugin.h>

PS_FOOTPRINT_CHOICES

struct state {
    PS_FOOTPRINT_MEMBERS
};

static uint32_t resolution(const void *state)
{
    (void)state;
    return 0;
}

static ps_footprint_settings boxes(const void *opaque)
{
    const struct state *state = opaque;
    return PS_FOOTPRINT_SETTINGS(state);
}

static void place(const void *opaque, const ps_host *host, const ps_photon *photons,
                  const ps_hit *hits, size_t n, ps_splat *splats)
{
    const struct state *state = opaque;
    ps_footprint_settings settings = boxes(state);
    host->place_footprints(host, &settings, photons, hits, n, splats);
}

static const ps_param params[] = {PS_FOOTPRINT_PARAMS(struct state, "auto", "no")};

static const ps_visibility_vtable vtable = {
    .size = sizeof vtable,
    .resolution = resolution,
    .boxes = boxes,
    .place = place,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "none",
    .version = "1.0",
    .summary = "lights everything inside a splat's box; light leaks",
    .paper = "Dachsbacher and Stamminger 2006, Splatting indirect illumination",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(visibility, none, &descriptor)
