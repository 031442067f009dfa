/* mesh.c: see mesh.h. */
#include "pbrt/mesh.h"

#include <math.h>
#include <stdlib.h>

/* Flat where a normal is missing; and pbrt's front is the one on the side of the normals. */
static void settle_normals(struct importer *importer, const struct statement *shape,
                           struct mesh *mesh)
{
    bool missing = false;
    for (size_t i = 0; i < mesh->vertex_count && mesh->normals; i++) {
        double length = vector_length(mesh->normals[i]);
        missing = missing || !(length > 1e-15) || !isfinite(length);
    }
    if (missing) {
        importer_warn(importer, &shape->origin, shape->width,
                      "normals of length 0: all of the shape are left out");
        free(mesh->normals);
        mesh->normals = NULL;
    }
    mesh_turn_to_normals(mesh);
}

void mesh_add(struct importer *importer, const struct statement *shape, struct mesh *mesh)
{
    struct transform placement;
    FILE *out = importer_objects(importer);
    settle_normals(importer, shape, mesh);
    if (importer->state.reverse)
        mesh_reverse(mesh);
    if (!importer_placement(importer, &importer->state.ctm, &shape->origin, shape->width,
                            &placement))
        return;
    struct surface surface = material_surface(importer, shape, mesh_area(mesh, &placement));
    if (!surface.material || mesh->triangle_count == 0)
        return;
    if (!mesh_put(&importer->scene, importer->options->base, out, mesh)) {
        importer_report_memory(importer);
        return;
    }
    surface_finish(importer, out, &surface, &placement);
}
