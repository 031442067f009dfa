/* box.c: the same weight all over the disc: least noise, sharp edges between splats. */
#include <psplat/plugin.h>

static void weigh(const void *state, const float *r2, float *weights, size_t n)
{
    (void)state;
    (void)r2;
    for (size_t i = 0; i < n; i++)
        weights[i] = 1.0f;
}

static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "box",
    .version = "1.0",
    .summary = "the same weight all over the splat",
    .paper = "Hoet 2014, section 3.3, figure 6",
    .vtable = &vtable,
};

PS_MODULE(filter, box, &descriptor)
