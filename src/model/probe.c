/* probe.c: Möller and Trumbore 1997, "Fast, minimum storage ray-triangle intersection". Each
 * triangle is placed once for all rays that meet the box around its object: many of few, of one
 * that has thousands of instances. */
#include "model/probe.h"

#include "scene/box.h"
#include <assert.h>

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

static void cut(float low, float high, float origin, float direction, float *from, float *to)
{
    float first = (low - origin) / direction, second = (high - origin) / direction;
    *from = fmaxf(*from, fminf(first, second)); /* of 0 / 0 the other */
    *to = fminf(*to, fmaxf(first, second));
}

/* Kay and Kajiya 1986, by slabs, with some room for rounding. */
static bool meets_box(const struct probe *probe, const struct box *box)
{
    float from = 0.0f, to = INFINITY;
    const ps_vec3 o = probe->origin, d = probe->direction;
    cut(box->low.x, box->high.x, o.x, d.x, &from, &to);
    cut(box->low.y, box->high.y, o.y, d.y, &from, &to);
    cut(box->low.z, box->high.z, o.z, d.z, &from, &to);
    return from * 0.9999f <= to * 1.0001f;
}

static struct box placed_box(const struct mesh_description *mesh, const struct affine *placement)
{
    struct box box = BOX_EMPTY;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        box_add_point(&box, affine_point(placement, mesh->vertices[i]));
    ps_vec3 room = ps_scale(ps_subtract(box.high, box.low), 1e-4f);
    return (struct box){ps_subtract(box.low, room), ps_add(box.high, room)};
}

static void probe_mesh(const struct mesh_description *mesh, const struct affine *placement,
                       struct probe *probes, size_t count)
{
    const struct box box = placed_box(mesh, placement);
    uint16_t met[PROBES_AT_MOST];
    size_t met_count = 0;
    for (size_t k = 0; k < count; k++)
        if (meets_box(&probes[k], &box))
            met[met_count++] = (uint16_t)k;
    if (met_count == 0)
        return;
    float side = affine_determinant(placement) < 0.0 ? -1.0f : 1.0f;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        ps_vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = affine_point(placement, mesh->vertices[mesh->triangles[i][k]]);
        struct triangle triangle = {p[0], {ps_subtract(p[1], p[0]), ps_subtract(p[2], p[0])}, p[0]};
        triangle.normal = ps_scale(ps_cross(triangle.edges[0], triangle.edges[1]), side);
        for (size_t k = 0; k < met_count; k++)
            meet(&probes[met[k]], &triangle);
    }
}

void probe_all(const struct scene_description *fragment, struct probe *probes, size_t count)
{
    assert(count <= PROBES_AT_MOST);
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
