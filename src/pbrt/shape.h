/* shape.h: pbrt's shapes as psplat's objects. */
#ifndef PBRT_SHAPE_H
#define PBRT_SHAPE_H

#include "pbrt/mesh.h"

/* Adds what a Shape statement says. */
void shape_add(struct importer *importer, const struct statement *statement);

/* Spheres, cylinders, cones, discs, paraboloids and hyperboloids (quadric.c); false: it is none of
 * them. */
bool quadric_add(struct importer *importer, const struct statement *statement);

/* Triangle meshes as pbrt lists them, and Loop subdivision of them (triangle_mesh.c). */
void triangle_mesh_add(struct importer *importer, const struct statement *statement);
void loop_subdivision_add(struct importer *importer, const struct statement *statement);

/* Bilinear patches and height fields (patch.c). */
void bilinear_mesh_add(struct importer *importer, const struct statement *statement);
void height_field_add(struct importer *importer, const struct statement *statement);

/* Divides each triangle into four, `levels` times, and moves the vertices to the limit surface
 * (subdivision.c). False: reported. */
bool subdivision_refine(struct importer *importer, const struct statement *statement,
                        struct mesh *mesh, long levels);

#endif
