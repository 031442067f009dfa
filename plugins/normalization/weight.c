/* weight.c: the thesis's normalization: sum of colour over sum of weight (Hoet 2014, section 3.4).
 *
 * The quotient is a mean of the splats' colours: smooth after few splats, but how many splats meet,
 * and so how much light arrives, drops out. Its scale is arbitrary: `exposure` sets it, `auto` by
 * giving the picture the mean of the density estimate.
 */
#include <psplat/plugin.h>

static const char *const exposure_choices[] = {"auto", NULL};

struct state {
    ps_number_or_choice exposure;
};

/* Ratio of the means of density estimate and quotient over the pixels that have weight. */
static double match_density(const ps_film_view *film)
{
    double density = 0, quotient = 0;
    for (uint64_t i = 0; i < film->pixel_count; i++) {
        if (!(film->weight[i] > 0.0f))
            continue;
        double sum = (double)film->color_r[i] + film->color_g[i] + film->color_b[i];
        density += sum / film->passes;
        quotient += sum / film->weight[i] * film->coverage[i] / film->passes;
    }
    return quotient > 0 ? density / quotient : 0;
}

static ps_result resolve(const void *opaque, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b)
{
    (void)host;
    const struct state *state = opaque;
    double exposure = state->exposure.choice < 0 ? state->exposure.number : match_density(film);
    for (uint64_t i = 0; i < film->pixel_count; i++) {
        float covered = film->coverage[i] / (float)film->passes;
        float scale = film->weight[i] > 0.0f ? (float)(exposure / film->weight[i]) * covered : 0.0f;
        out_r[i] = film->color_r[i] * scale;
        out_g[i] = film->color_g[i] * scale;
        out_b[i] = film->color_b[i] * scale;
    }
    return PS_OK;
}

static const ps_param params[] = {
    PS_NUMBER_OR(struct state, exposure, "auto", 0, INFINITY, 0, exposure_choices, "",
                 "factor on the quotient; auto: match the mean of density"),
};

static const ps_normalization_vtable vtable = {.size = sizeof vtable, .resolve = resolve};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_NORMALIZATION,
    .name = "weight",
    .version = "1.0",
    .summary = "colour sum over weight sum: smooth with few splats, loses differences in intensity",
    .paper = "Hoet 2014, section 3.4",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(normalization, weight, &descriptor)
