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

/* --- polygons ------------------------------------------------------------------------------------- */

/* Twice the area of the triangle, above 0 where it turns counter-clockwise. */
static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool is_within(const double p[2], const double a[2], const double b[2], const double c[2],
                      double side)
{
    return side * turn(a, b, p) >= 0.0 && side * turn(b, c, p) >= 0.0 &&
           side * turn(c, a, p) >= 0.0;
}

static bool is_same(const double a[2], const double b[2])
{
    return a[0] == b[0] && a[1] == b[1];
}

static bool is_ear(const double (*points)[2], const uint32_t *ring, size_t count, size_t i,
                   double side)
{
    size_t before = (i + count - 1) % count, behind = (i + 1) % count;
    const double *a = points[ring[before]], *b = points[ring[i]], *c = points[ring[behind]];
    if (side * turn(a, b, c) <= 0.0)
        return false;
    for (size_t k = 0; k < count; k++) {
        const double *p = points[ring[k]];
        bool is_corner = k == before || k == i || k == behind || is_same(p, a) || is_same(p, c);
        if (!is_corner && is_within(p, a, b, c, side))
            return false;
    }
    return true;
}

size_t pov_triangulate(const double (*points)[2], size_t count, uint32_t (*triangles)[3])
{
    uint32_t *ring = malloc((count + 1) * sizeof *ring);
    double area = 0.0;
    size_t made = 0, i = 0, tries = 0;
    for (size_t k = 0; k < count && ring; k++) {
        const double *a = points[k], *b = points[(k + 1) % count];
        area += a[0] * b[1] - a[1] * b[0];
        ring[k] = (uint32_t)k;
    }
    double side = area < 0.0 ? -1.0 : 1.0;
    while (ring && count >= 3 && tries < count) {
        if (count > 3 && !is_ear(points, ring, count, i % count, side)) {
            i++;
            tries++;
            continue;
        }
        i %= count;
        triangles[made][0] = ring[(i + count - 1) % count];
        triangles[made][1] = ring[i];
        triangles[made++][2] = ring[(i + 1) % count];
        memmove(ring + i, ring + i + 1, (count - i - 1) * sizeof *ring);
        count--;
        tries = 0;
    }
    free(ring);
    return made;
}
