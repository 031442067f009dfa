/* chroma.c: the shoulder of `filmic` on the luminance alone, so that colours keep their hue.
 *
 * The luminance L becomes f(L), and the colour is multiplied by f(L) / L. A saturated colour may
 * then have a channel above 1. Cutting that off would turn orange to yellow; so the colour moves
 * straight towards the grey of its luminance until it fits (Stone, Cowan and Beatty 1988, Color
 * gamut mapping and the printing of digital color images):
 *
 *     c' = f + t (c - f)    t = (1 - f) / (max c - f)
 *
 * Hue and luminance stay, in linear light; only saturation goes, and all of it where f nears 1.
 */
#include <psplat/plugin.h>

struct state {
    double shoulder;
};

static void map_pixel(const void *opaque, float rgb[3])
{
    const struct state *state = opaque;
    double luminance = (double)ps_luminance((ps_rgb){rgb[0], rgb[1], rgb[2]});
    double most = fmax(fmax((double)rgb[0], (double)rgb[1]), (double)rgb[2]);
    if (!(luminance > 0.0))
        return;
    double mapped = ps_shoulder(luminance, state->shoulder), factor = mapped / luminance;
    double keeps = most * factor > 1.0 ? (1.0 - mapped) / (most * factor - mapped) : 1.0;
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)fmax(mapped + keeps * ((double)rgb[c] * factor - mapped), 0.0);
}

static ps_result map(const void *state, const ps_host *host, const ps_display_view *picture)
{
    return ps_map_pixels(state, host, picture, map_pixel);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, shoulder, "0.6", 0, 1, PS_PARAM_OPEN_MAX, "",
              "luminance at which the straight line ends"),
};

static const ps_tonemap_vtable vtable = {.size = sizeof vtable, .map = map};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_TONEMAP,
    .name = "chroma",
    .version = "1.0",
    .summary = "bends bright luminances along a shoulder, and keeps hues",
    .paper = "Stone, Cowan and Beatty 1988, Color gamut mapping and the printing of digital color "
             "images",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(tonemap, chroma, &descriptor)
