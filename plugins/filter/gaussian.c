/* gaussian.c: weight exp(-r^2 / (2 sigma^2)), cut off at the splat's edge. */
#include <psplat/plugin.h>

struct state {
    double sigma;
};

static void weigh(const void *opaque, const float *r2, float *weights, size_t n)
{
    const struct state *state = opaque;
    double factor = -0.5 / (state->sigma * state->sigma);
    for (size_t i = 0; i < n; i++)
        weights[i] = (float)exp(factor * r2[i]);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, sigma, "0.5", 0.05, 10, 0, "radii",
              "standard deviation, as a fraction of the splat's radius"),
};

static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "gaussian",
    .version = "1.0",
    .summary = "a bell-shaped weight: the smoothest overlap",
    .paper = "Hoet 2014, section 3.3, figure 6",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(filter, gaussian, &descriptor)
