/* filter.c: an example: weight ((1 + cos(pi r)) / 2) ^ sharpness, a raised cosine over the disc. */
#include <psplat/plugin.h>

struct state {
    double sharpness;
};

static void weigh(const void *opaque, const float *r2, float *weights, size_t n)
{
    const struct state *state = opaque;
    for (size_t i = 0; i < n; i++) {
        float bell = 0.5f + 0.5f * cosf(PS_PI * sqrtf(r2[i]));
        weights[i] = powf(bell, (float)state->sharpness);
    }
}

static const ps_param params[] = {
    PS_NUMBER(struct state, sharpness, "1", 0, 16, 0, "", "power of the raised cosine; 0: a box"),
};

static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "cosine",
    .version = "1.0",
    .summary = "a raised cosine",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(filter, cosine, &descriptor)
