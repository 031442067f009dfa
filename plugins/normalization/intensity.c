/* intensity.c: weight-normalized colour times weight over the maximum weight (Hoet 2014, section
 * 3.4).
 *
 * The idea is to give the quotient C / W of the normalization `weight` back what it lost, how many
 * splats meet in a pixel, by the ratio of W to the picture's largest weight M:
 *
 *     exposure * C / W * W / M  =  exposure / M * C
 *
 * W cancels, whatever the splats are. So this is the density estimate up to one factor for the
 * whole picture, with all of its noise (which section 3.4 foresees) and none of the quotient's
 * smoothness; and where `auto` matches the mean of density, it is the density estimate itself. A
 * number makes the factor hang on the one pixel with the largest weight, as in the thesis.
 *
 * A pixel that saw a surface in some passes only has its weight from these, so M is the largest
 * weight in a covered pass, and the picture fades with coverage.
 */
#include <psplat/plugin.h>

static const char *const exposure_choices[] = {"auto", NULL};

struct state {
    ps_number_or_choice exposure;
};

static float maximum_weight(const ps_film_view *film)
{
    float maximum = 0.0f;
    for (uint64_t i = 0; i < film->pixel_count; i++)
        if (film->weight[i] > 0.0f)
            maximum = fmaxf(maximum, film->weight[i] / film->coverage[i]);
    return maximum;
}

/* What the density estimate is multiplied with. */
static double density_factor(const struct state *state, const ps_film_view *film)
{
    if (state->exposure.choice >= 0)
        return 1.0;
    float maximum = maximum_weight(film);
    return maximum > 0.0f ? state->exposure.number / maximum : 0.0;
}

static ps_result resolve(const void *opaque, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b)
{
    (void)host;
    float scale = film->passes ? (float)(density_factor(opaque, film) / film->passes) : 0.0f;
    for (uint64_t i = 0; i < film->pixel_count; i++) {
        out_r[i] = film->color_r[i] * scale;
        out_g[i] = film->color_g[i] * scale;
        out_b[i] = film->color_b[i] * scale;
    }
    return PS_OK;
}

static const ps_param params[] = {
    PS_NUMBER_OR(struct state, exposure, "auto", 0, INFINITY, 0, exposure_choices, "",
                 "factor on the product; auto: match the mean of density"),
};

static const ps_normalization_vtable vtable = {.size = sizeof vtable, .resolve = resolve};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_NORMALIZATION,
    .name = "intensity",
    .version = "1.0",
    .summary = "colour over weight, times weight over the largest weight: density up to a factor",
    .paper = "Hoet 2014, section 3.4",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(normalization, intensity, &descriptor)
