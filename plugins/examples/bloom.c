/* bloom.c: an example: streaks, which run from bright light to the right and fade, as on a wiped
 * lens. */
#include <psplat/plugin.h>

struct state {
    double strength, fade;
};

/* Of the light of each pixel a share goes on to the right, where of what arrives so much lands in
 * each pixel; the last one takes all that is left. */
static void streak(const struct state *state, uint32_t width, float *row)
{
    double carried = 0.0;
    for (uint32_t x = 0; x < width; x++) {
        double lands = x + 1 < width ? carried * state->fade : carried;
        double leaves = x + 1 < width ? (double)row[x] * state->strength : 0.0;
        carried += leaves - lands;
        row[x] = (float)((double)row[x] - leaves + lands);
    }
}

static ps_result spread(const void *state, const ps_host *host, const ps_display_view *picture)
{
    float *const planes[3] = {picture->r, picture->g, picture->b};
    for (int c = 0; c < 3 && !host->cancelled(host); c++)
        for (uint32_t y = 0; y < picture->height; y++)
            streak(state, picture->width, planes[c] + (size_t)y * picture->width);
    return host->cancelled(host) ? PS_CANCELLED : PS_OK;
}

static const ps_param params[] = {
    PS_NUMBER(struct state, strength, "0.1", 0, 1, 0, "", "share of the light that is carried on"),
    PS_NUMBER(struct state, fade, "0.2", 0, 1, PS_PARAM_OPEN_MIN, "",
              "share of what arrives that lands in a pixel"),
};

static const ps_bloom_vtable vtable = {.size = sizeof vtable, .spread = spread};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_BLOOM,
    .name = "streaks",
    .version = "1.0",
    .summary = "carries light on to the right",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(bloom, streaks, &descriptor)
