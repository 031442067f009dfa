/* sppm.c: stochastic progressive photon mapping: photon mapping whose bias goes away with the
 * passes.
 *
 * Hachisuka, Ogaki and Jensen 2008; Hachisuka and Jensen 2009. Every pass traces new photons, looks
 * at other points of the pixels, and estimates the irradiance with a smaller radius than the pass
 * before. After Knaus and Zwicker 2011 a pass needs nothing of those before it: its radius is
 *
 *     r_i = s_i r,   s_i^2 = product over j = 1 .. i of (j + alpha) / (j + 1),   i = 0, 1, 2, ...
 *
 * and the mean over N passes has a variance that falls with N^-alpha and a bias that falls with
 * N^(alpha - 1): both go to 0 for 0 < alpha < 1, and with alpha = 2/3 the error falls with
 * N^(-1/3), the best rate there is.
 *
 * r, in place of statistics that a pixel keeps, is the distance of the k-th photon in the pass's
 * own map. So radii are small where photons are dense, as those of pixels that count their photons
 * become (Kaplanyan and Dachsbacher 2013), and a pass stays a function of its number. Photons
 * within s of that distance are as dense as those within it, so that shrinking brings no bias of
 * its own.
 */
#include "shared/photon_map.h"

static const char *const filter_choices[] = {"box", "cone", "gaussian", NULL};

struct state {
    int64_t neighbours;
    double alpha;
    int32_t filter;
};

static float shrink_of(uint32_t pass, double alpha)
{
    double square = 1.0;
    for (uint32_t j = 1; j <= pass; j++)
        square *= (j + alpha) / (j + 1.0);
    return (float)sqrt(square);
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    const struct photon_estimate how = {.filter = state->filter,
                                        .max_radius = INFINITY,
                                        .shrink = shrink_of(pass->number, state->alpha)};
    struct photon_map map;
    ps_result result = photon_map_create(host, pass, PHOTONS_ARRIVE, state->neighbours, &map);
    if (result == PS_OK && map.index)
        result = photon_map_light_pixels(&map, &how);
    photon_map_release(&map);
    return result;
}

static const ps_param params[] = {
    PS_INT(struct state, neighbours, "50", 2, 100000, "photons",
           "photons that an estimate of the first pass is made of"),
    PS_NUMBER(struct state, alpha, "0.667", 0, 1,
              PS_PARAM_OPEN_MIN | PS_PARAM_OPEN_MAX | PS_PARAM_EXPERT, "",
              "how slowly radii shrink: variance falls with passes^-alpha, bias with "
              "passes^(alpha - 1)"),
    PS_ROW(struct state, filter, PS_PARAM_CHOICE, "cone", 0, 0, PS_PARAM_EXPERT, filter_choices, "",
           "radial weight of the photons"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "sppm",
    .version = "1.0",
    .summary = "progressive photon mapping: radii shrink from pass to pass, and the bias goes away",
    .paper = "Hachisuka and Jensen 2009, Stochastic progressive photon mapping; Knaus and Zwicker "
             "2011, Progressive photon mapping: a probabilistic approach",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, sppm, &descriptor)
