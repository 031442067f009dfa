/* tent.c: weight 1 - r, a cone over the disc that falls to 0 at its rim. For one that is cut off
 * before see cone.c, which is this at k = 1. */
#include <psplat/plugin.h>

static void weigh(const void *state, const float *r2, float *weights, size_t n)
{
    (void)state;
    for (size_t i = 0; i < n; i++)
        weights[i] = 1.0f - sqrtf(r2[i]);
}

static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "tent",
    .version = "1.0",
    .summary = "a weight that falls linearly from the centre to the edge",
    .paper = "Hoet 2014, section 3.3, figure 6",
    .vtable = &vtable,
};

PS_MODULE(filter, tent, &descriptor)
