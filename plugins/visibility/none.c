/* none.c: no visibility: everything inside a footprint that faces the light is lit.
 *
 * What splatting would be if the visibility term were left out, as by Dachsbacher and Stamminger
 * 2006: light leaks behind whatever the central ray misses. Good for seeing what a shadow map is
 * worth. The reach of the footprint (`depth`) decides how far light leaks.
 */
#include <psplat/plugin.h>

static const ps_visibility_vtable vtable = {.size = sizeof vtable};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_VISIBILITY,
    .name = "none",
    .version = "1.0",
    .summary = "lights everything inside of a footprint; light leaks",
    .paper = "Dachsbacher and Stamminger 2006, Splatting indirect illumination",
    .vtable = &vtable,
};

PS_MODULE(visibility, none, &descriptor)
