/* filmic.c: a straight line with a shoulder, on each channel apart (ps_shoulder).
 *
 * Most of a picture keeps its radiance; highlights bend towards 1 in place of being cut off.
 * Channels are treated apart, as film's layers are: bright colours fade towards white, and their
 * hues shift a little on the way.
 */
#include <psplat/plugin.h>

struct state {
    double shoulder;
};

static void map_pixel(const void *opaque, float rgb[3])
{
    const struct state *state = opaque;
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)ps_shoulder((double)rgb[c], state->shoulder);
}

static ps_result map(const void *state, const ps_host *host, const ps_display_view *picture)
{
    return ps_map_pixels(state, host, picture, map_pixel);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, shoulder, "0.6", 0, 1, PS_PARAM_OPEN_MAX, "",
              "where the straight line ends; smaller ones keep more of highlights apart"),
};

static const ps_tonemap_vtable vtable = {.size = sizeof vtable, .map = map};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_TONEMAP,
    .name = "filmic",
    .version = "1.0",
    .summary = "bends highlights towards white along a shoulder, channel by channel",
    .paper = "Ferschin, Tastl and Purgathofer 1994, A comparison of techniques for the "
             "transformation of radiosity values to monitor colors",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(tonemap, filmic, &descriptor)
