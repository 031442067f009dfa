/* surface.h: collects the triangles of an object. */
#ifndef POV_SURFACE_H
#define POV_SURFACE_H

#include "pov/object.h"

struct pov_corner {
    struct vector point, normal;
    double uv[2];
};

/* Zeroed but for the first members: empty. One finish releases it. */
struct pov_surface {
    struct pov_reader *reader;
    bool has_normals, has_uv;
    struct pov_corner *corners; /* three for each triangle */
    size_t count, capacity;
};

/* Leaves out what has no area. */
void pov_surface_triangle(struct pov_surface *surface, const struct pov_corner corners[3]);
/* The object becomes that mesh; of no triangles, nothing. */
void pov_surface_finish(struct pov_surface *surface, struct pov_object *object);
/* The same of a mesh, which is released. */
void pov_surface_adopt(struct pov_reader *reader, struct mesh *mesh, struct pov_object *object);

#endif
