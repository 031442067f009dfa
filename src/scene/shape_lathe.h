/* shape_lathe.h: surfaces of revolution, written ring by ring into a mesh that was allocated for
 * them.
 *
 * With the axis upwards and the profile drawn to the right of it, the front lies to the right of
 * the profile's way: it goes up the outside of a solid. u grows counter-clockwise as seen from
 * where the axis points.
 */
#ifndef SCENE_SHAPE_LATHE_H
#define SCENE_SHAPE_LATHE_H

#include "scene/shape_build.h"

struct lathe {
    struct shape *shape;
    ps_vec3 origin, axis;
    ps_vec3 start, quarter; /* unit: away from the axis at u = 0 and u = 1/4 */
    size_t segments;
    size_t vertices, triangles; /* written so far */
    size_t ring;                /* vertex that starts the last ring */
    bool ring_is_pole;
};

/* A point of the profile: distance from the axis and place along it, in scene units; the normal in
 * the same plane, unit. */
struct profile_point {
    float radius, height;
    float normal_radius, normal_height;
    float v;
};

/* For a unit axis; u starts as the frame of shape_frame says, -x for +y. */
struct lathe lathe_begin(struct shape *shape, ps_vec3 origin, ps_vec3 axis, size_t segments);

/* A ring takes segments + 1 vertices, as u = 0 and u = 1 differ, and on the axis a vertex for each
 * segment. */
static inline size_t lathe_ring_vertices(size_t segments, float radius)
{
    return segments + (radius > 0.0f);
}

/* Triangles between two rings; no two rings that follow each other lie both on the axis. */
static inline size_t lathe_strip_triangles(size_t segments, float radius, float next_radius)
{
    return segments * ((size_t)(radius > 0.0f) + (size_t)(next_radius > 0.0f));
}

void lathe_ring(struct lathe *lathe, const struct profile_point *point);

/* The same, joined with the ring before. */
void lathe_join(struct lathe *lathe, const struct profile_point *point);

/* A flat ring around the axis at `height`, from `hole` (0: none) to `radius`, on vertices of its
 * own. Its front is along the axis, or against it. */
void lathe_disc(struct lathe *lathe, float height, float radius, float hole, bool along_axis);

static inline size_t lathe_disc_vertices(size_t segments, float hole)
{
    return hole > 0.0f ? 2 * segments : segments + 1;
}

static inline size_t lathe_disc_triangles(size_t segments, float hole)
{
    return hole > 0.0f ? 2 * segments : segments;
}

#endif
