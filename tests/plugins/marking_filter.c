/* marking_filter.c: a filter whose constructor makes a file, so that a test sees whether it was
 * loaded. */
#include <psplat/plugin.h>

#include <stdio.h>

extern void leave_mark(void);
__attribute__((constructor)) void leave_mark(void)
{
    FILE *file = fopen(MARK, "w");
    if (file)
        fclose(file);
}

static void weigh(const void *state, const float *r2, float *weights, size_t n)
{
    (void)state;
    for (size_t i = 0; i < n; i++)
        weights[i] = 1.0f - r2[i];
}

static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_FILTER,
    .name = "marking",
    .version = "1.0",
    .summary = "a filter that leaves a mark",
    .paper = "none: a test",
    .vtable = &vtable,
};

PS_MODULE(filter, marking, &descriptor)
