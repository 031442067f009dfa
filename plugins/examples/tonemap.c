/* tonemap.c: an example: luminance by its logarithm (Drago et al. 2003, without their bias). */
#include <psplat/plugin.h>

struct state {
    double white;
};

/* log(1 + L) / log(1 + white): 0 stays, and the luminance `white` becomes 1. */
static void map_pixel(const void *opaque, float rgb[3])
{
    const struct state *state = opaque;
    double luminance = (double)ps_luminance((ps_rgb){rgb[0], rgb[1], rgb[2]});
    if (!(luminance > 0.0))
        return;
    double factor = log1p(luminance) / log1p(state->white) / luminance;
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)fmin((double)rgb[c] * factor, 1.0);
}

static ps_result map(const void *state, const ps_host *host, const ps_display_view *picture)
{
    return ps_map_pixels(state, host, picture, map_pixel);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, white, "10", 0, INFINITY, PS_PARAM_OPEN_MIN, "",
              "luminance that becomes 1"),
};

static const ps_tonemap_vtable vtable = {.size = sizeof vtable, .map = map};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_TONEMAP,
    .name = "logarithm",
    .version = "1.0",
    .summary = "luminance by its logarithm",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(tonemap, logarithm, &descriptor)
