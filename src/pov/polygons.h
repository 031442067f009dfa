/* polygons.h: lists of convex polygons that planes cut, for solids by boolean operations. */
#ifndef POV_POLYGONS_H
#define POV_POLYGONS_H

#include "scene/vector.h"
#include <stdbool.h>
#include <stddef.h>

struct csg_vertex {
    struct vector point, normal;
};

struct csg_polygon {
    size_t start, count; /* in the vertices of its list */
};

/* What cutting may still cost. */
struct csg_budget {
    size_t steps; /* planes times corners */
    size_t bytes;
    bool spent; /* more was asked for */
};

/* Zeroed: empty. Owns its arrays. */
struct csg_polygons {
    struct csg_budget *budget; /* what its arrays come from; or NULL */
    struct csg_vertex *vertices;
    struct csg_polygon *list;
    size_t vertex_count, vertex_capacity, count, capacity;
};

/* normal . p < distance behind it; normal of length 1. */
struct csg_plane {
    struct vector normal;
    double distance;
};

/* The convex solid behind all of the planes; of none, all of space. */
struct csg_convex {
    struct csg_plane *planes;
    size_t plane_count;
    struct vector center; /* of a sphere around it */
    double radius;        /* INFINITY: there is none */
};

/* Takes from the budget. False: it is spent. */
bool csg_take(struct csg_budget *budget, size_t steps, size_t bytes);

void csg_polygons_release(struct csg_polygons *polygons);
void csg_polygons_clear(struct csg_polygons *polygons);
/* False: out of memory, or the budget is spent. */
bool csg_polygons_add(struct csg_polygons *polygons, const struct csg_vertex *vertices,
                      size_t count);

/* Adds to `inside` and `outside` what of the polygons is so; each may be NULL. What lies within
 * `tolerance` of a plane counts as behind it. False: out of memory, or the budget is spent. */
bool csg_cut(const struct csg_polygons *polygons, const struct csg_convex *convex, double tolerance,
             struct csg_polygons *inside, struct csg_polygons *outside, struct csg_budget *budget);

#endif
