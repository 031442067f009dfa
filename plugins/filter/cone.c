/* cone.c: weight 1 - r / k, Jensen's cone filter: a cone of radius k that the disc of radius 1
 * cuts.
 *
 * At k = 1 it is the filter tent, which falls to 0 at the rim; a larger k leaves 1 - 1/k of the
 * weight there, on the way to the filter box. Flatter splats are less noisy and show their edges.
 */
#include <psplat/plugin.h>

struct state {
    double k;
};

static void weigh(const void *opaque, const float *r2, float *weights, size_t n)
{
    const struct state *state = opaque;
    float slope = (float)(1.0 / state->k);
    for (size_t i = 0; i < n; i++)
        weights[i] = 1.0f - slope * sqrtf(r2[i]);
}

static const ps_param params[] = {
    PS_NUMBER(struct state, k, "2", 1, 1000, 0, "radii",
              "radius at which the weight would reach 0; 1: tent, large: box"),
};

static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "cone",
    .version = "1.0",
    .summary = "a cone that the splat's edge cuts: between tent and box",
    .paper = "Jensen 1996, Global illumination using photon maps",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(filter, cone, &descriptor)
