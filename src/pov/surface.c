/* surface.c: see surface.h. */
#include "pov/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_finite_vector(struct vector a)
{
    return fabs(a.x) <= 1e30 && fabs(a.y) <= 1e30 && fabs(a.z) <= 1e30;
}

static bool has_area(const struct pov_corner corners[3])
{
    struct vector a = vector_subtract(corners[1].point, corners[0].point);
    struct vector b = vector_subtract(corners[2].point, corners[0].point);
    double longest = fmax(vector_dot(a, a), vector_dot(b, b));
    return vector_length(vector_cross(a, b)) > 1e-12 * longest;
}

void pov_surface_triangle(struct pov_surface *surface, const struct pov_corner corners[3])
{
    struct pov_reader *reader = surface->reader;
    for (int k = 0; k < 3; k++)
        if (!is_finite_vector(corners[k].point))
            return;
    if (reader->stopped || !has_area(corners))
        return;
    if (surface->count / 3 == MESH_TRIANGLES_LIMIT) {
        pov_error(reader, pov_peek(reader), "a mesh has more than %zu triangles",
                  MESH_TRIANGLES_LIMIT);
        return;
    }
    if (!pov_charge(reader, 3, sizeof *surface->corners) ||
        !pov_grow(reader, (void **)&surface->corners, &surface->capacity, surface->count + 3,
                  sizeof *surface->corners))
        return;
    memcpy(surface->corners + surface->count, corners, 3 * sizeof *corners);
    surface->count += 3;
}

/* A normal of no length would be an error in the new scene: the triangle's stands in for it. */
static struct vector settle_normal(const struct pov_corner *corners, size_t k)
{
    struct vector n = corners[k].normal;
    if (vector_length(n) > 1e-15 && is_finite_vector(n))
        return n;
    struct vector a = vector_subtract(corners[1].point, corners[0].point);
    struct vector b = vector_subtract(corners[2].point, corners[0].point);
    n = vector_cross(a, b);
    return vector_unit(n);
}

const struct mesh *pov_keep_mesh(struct pov_reader *reader, struct mesh *mesh)
{
    struct mesh kept = {.vertex_count = mesh->vertex_count, .triangle_count = mesh->triangle_count};
    kept.points = pov_copy(reader, mesh->points, mesh->vertex_count * sizeof *mesh->points);
    kept.triangles =
        pov_copy(reader, mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    if (mesh->normals)
        kept.normals = pov_copy(reader, mesh->normals, mesh->vertex_count * sizeof *mesh->normals);
    if (mesh->uv)
        kept.uv = pov_copy(reader, mesh->uv, mesh->vertex_count * sizeof *mesh->uv);
    mesh_release(mesh);
    return reader->stopped ? NULL : pov_copy(reader, &kept, sizeof kept);
}

void pov_surface_adopt(struct pov_reader *reader, struct mesh *mesh, struct pov_object *object)
{
    object->shape = mesh->triangle_count > 0 ? POV_SHAPE_MESH : POV_SHAPE_NOTHING;
    if (mesh->triangle_count > 0)
        object->mesh = pov_keep_mesh(reader, mesh);
    else
        mesh_release(mesh);
}

void pov_surface_finish(struct pov_surface *surface, struct pov_object *object)
{
    struct mesh mesh = {0};
    size_t count = surface->count;
    if (surface->reader->stopped) {
        free(surface->corners);
        return;
    }
    if (!mesh_allocate(&mesh, count, surface->has_normals, surface->has_uv, count / 3)) {
        pov_no_memory(surface->reader);
        free(surface->corners);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const struct pov_corner *triangle = surface->corners + i / 3 * 3;
        mesh.points[i] = surface->corners[i].point;
        mesh.triangles[i / 3][i % 3] = (uint32_t)i;
        if (surface->has_normals)
            mesh.normals[i] = settle_normal(triangle, i % 3);
        if (surface->has_uv)
            memcpy(mesh.uv[i], surface->corners[i].uv, sizeof mesh.uv[i]);
    }
    mesh_turn_to_normals(&mesh);
    free(surface->corners);
    pov_surface_adopt(surface->reader, &mesh, object);
}
