/* mesh.h: meshes of pbrt's shapes as objects of the scene. */
#ifndef PBRT_MESH_H
#define PBRT_MESH_H

#include "pbrt/material.h"
#include "writer/mesh.h"

/* Adds the mesh as an object, by the shape statement's material and the current transform.
 * ReverseOrientation counts. */
void mesh_add(struct importer *importer, const struct statement *shape, struct mesh *mesh);

#endif
