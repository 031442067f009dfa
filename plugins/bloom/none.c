/* none.c: light stays where it is, as behind a perfect lens. */
#include <psplat/plugin.h>

static const ps_bloom_vtable vtable = {.size = sizeof vtable};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_BLOOM,
    .name = "none",
    .version = "1.0",
    .summary = "leaves the picture as it is",
    .paper = "none: a perfect lens",
    .vtable = &vtable,
};

PS_MODULE(bloom, none, &descriptor)
