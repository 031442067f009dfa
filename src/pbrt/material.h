/* material.h: pbrt's materials, area lights and alpha as psplat's materials. */
#ifndef PBRT_MATERIAL_H
#define PBRT_MATERIAL_H

#include "pbrt/importer.h"

/* How a shape looks. */
struct surface {
    const char *material; /* its name in the scene; NULL: the shape is left out */
    bool unseen;          /* by the camera: pbrt's lights with alpha 0 */
    bool one_sided;       /* its front matters: it shines there, or is the border of glass */
    bool has_holes;
};

/* The surface of a shape in the current graphics state. `area` is the shape's in the scene, for
 * lights with a power; below 0: not known. */
struct surface material_surface(struct importer *importer, const struct statement *shape,
                                double area);

/* Writes the keys material, camera and matrix, and the end of an object's map. */
void surface_finish(struct importer *importer, FILE *out, const struct surface *surface,
                    const struct transform *placement);

struct pattern;

/* The opacity of pbrt-v3's uber; false: it states none, or is of another kind. */
bool material_opacity(struct importer *importer, const struct statement *statement,
                      struct pattern *opacity);

/* Writes psd(5)'s keys of a material, but for its opacity; false, with nothing written, for one
 * that is no surface. `depth` counts mixes that it is in. */
bool material_put(struct importer *importer, FILE *out, const struct statement *statement,
                  int depth);

/* The same for materials that are mixes of others. */
void material_put_mix(struct importer *importer, FILE *out, const struct statement *statement,
                      int depth);

bool material_is_named(const struct importer *importer, const char *name);
/* Of a material that was named before; NULL, reported: there is none. */
const struct statement *material_find(struct importer *importer, const char *name,
                                      const struct place *place);

#endif
