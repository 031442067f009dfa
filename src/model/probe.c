/* probe.c: Möller and Trumbore 1997, Fast, minimum storage ray-triangle intersection; each triangle is placed once
 * for all rays. */
#include "model/probe.h"

#include <psplat/math.h>

struct triangle {
    ps_vec3 corner, edges[2];
    ps_vec3 normal; /* on the front, of any length */
};

static void meet(struct probe *probe, const struct triangle *triangle)
{
    ps_vec3 p = ps_cross(probe->direction, triangle->edges[1]);
    float determinant = ps_dot(triangle->edges[0], p);
    if (determinant == 0.0f)
        return;
    ps_vec3 from = ps_subtract(probe->origin, triangle->corner);
    float u = ps_dot(from, p) / determinant;
    if (!(u >= 0.0f && u <= 1.0f))
        return;
    ps_vec3 q = ps_cross(from, triangle->edges[0]);
    float v = ps_dot(probe->direction, q) / determinant;
    float distance = ps_dot(triangle->edges[1], q) / determinant;
    if (!(v >= 0.0f && u + v <= 1.0f && distance > 0.0f))
        return;
    bool faces = ps_dot(triangle->normal, probe->direction) < 0.0f;
    if (distance < probe->nearest) {
        probe->nearest = distance;
        probe->nearest_faces = faces;
    }
    if (distance > probe->farthest) {
        probe->farthest = distance;
        probe->farthest_faces = faces;
    }
}

static void probe_mesh(const struct mesh_description *mesh, const struct affine *placement,
                       struct probe *probes, size_t count)
{
    float side = affine_determinant(placement) < 0.0 ? -1.0f : 1.0f;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        ps_vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = affine_point(placement, mesh->vertices[mesh->triangles[i][k]]);
        struct triangle triangle = {p[0], {ps_subtract(p[1], p[0]), ps_subtract(p[2], p[0])}, p[0]};
        triangle.normal = ps_scale(ps_cross(triangle.edges[0], triangle.edges[1]), side);
        for (size_t k = 0; k < count; k++)
            meet(&probes[k], &triangle);
    }
}

void probe_all(const struct scene_description *fragment, struct probe *probes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        probes[i].nearest = INFINITY;
        probes[i].farthest = 0.0f;
    }
    for (size_t i = 0; i < fragment->object_count; i++) {
        const struct object_description *object = &fragment->objects[i];
        if (object->kind == OBJECT_MESH)
            probe_mesh(&fragment->meshes[object->mesh], &object->placement, probes, count);
    }
}
