/* reinhard.c: the global operator of Reinhard et al. 2002, equation 4, on the luminance L:
 *
 *     f(L) = L (1 + L / w^2) / (1 + L)
 *
 * The luminance w becomes 1, small ones stay nearly as they are. Channels are multiplied by f(L) /
 * L, which keeps their ratios, so that a bright saturated colour may have a channel above 1, which
 * is cut off; `chroma` takes care of those.
 */
#include <psplat/plugin.h>

struct state {
    double white;
};

static void map_pixel(const void *opaque, float rgb[3])
{
    const struct state *state = opaque;
    double luminance = (double)ps_luminance((ps_rgb){rgb[0], rgb[1], rgb[2]});
    double factor = (1.0 + luminance / (state->white * state->white)) / (1.0 + luminance);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)fmin((double)rgb[c] * factor, 1.0);
}

static ps_result map(const void *state, const ps_host *host, const ps_display_view *picture)
{
    return ps_map_pixels(state, host, picture, map_pixel);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, white, "4", 0.001, INFINITY, 0, "",
              "smallest luminance that becomes 1, in units of the exposed picture"),
};

static const ps_tonemap_vtable vtable = {.size = sizeof vtable, .map = map};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_TONEMAP,
    .name = "reinhard",
    .version = "1.0",
    .summary = "compresses all luminances, the brighter the more, up to a white point",
    .paper = "Reinhard et al. 2002, Photographic tone reproduction for digital images",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(tonemap, reinhard, &descriptor)
