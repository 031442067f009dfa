/* normalization.c: an example: the light over the number of passes, times a factor. */
#include <psplat/plugin.h>

struct state {
    double factor;
};

static ps_result resolve(const void *opaque, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b)
{
    (void)host;
    const struct state *state = opaque;
    float scale = film->passes ? (float)(state->factor / film->passes) : 0.0f;
    for (uint64_t i = 0; i < film->pixel_count; i++) {
        out_r[i] = scale * film->color_r[i];
        out_g[i] = scale * film->color_g[i];
        out_b[i] = scale * film->color_b[i];
    }
    return PS_OK;
}

static const ps_param params[] = {
    PS_NUMBER(struct state, factor, "1", 0, 1e6, 0, "", "factor on the indirect light"),
};

static const ps_normalization_vtable vtable = {
    .size = sizeof vtable,
    .resolve = resolve,
#if PS_ABI_MINOR >= 7
    .flags = PS_NORMALIZATION_CROPS,
#endif
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_NORMALIZATION,
    .name = "factor",
    .version = "1.0",
    .summary = "indirect light times a factor",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(normalization, factor, &descriptor)
