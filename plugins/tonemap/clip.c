/* clip.c: values above 1 are 1, which psplat sees to behind any tone map: the display values of
 * Hoet 2014, and those that comparisons use.
 */
#include <psplat/plugin.h>

static const ps_tonemap_vtable vtable = {.size = sizeof vtable};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_TONEMAP,
    .name = "clip",
    .version = "1.0",
    .summary = "cuts off what is brighter than the display",
    .paper = "Hoet 2014, section 3.6",
    .vtable = &vtable,
};

PS_MODULE(tonemap, clip, &descriptor)
