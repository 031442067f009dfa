/* triangle_mesh.c: meshes as pbrt lists them: points "P", "indices" by threes, and for each point
 * "N" and "uv" (in pbrt-v3 also "st").
 */
#include "pbrt/shape.h"

#include <math.h>
#include <string.h>

/* False: reported. */
static bool read_indices(struct importer *importer, const struct statement *statement,
                         const double *indices, struct mesh *mesh)
{
    const struct parameter *parameter = statement_find(statement, "indices");
    struct place place = statement_place(statement, parameter);
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        double index = indices[i];
        if (!(index >= 0.0 && index < (double)mesh->vertex_count) || index != floor(index)) {
            importer_error(importer, place.origin, place.width, "indices: expected 0..%zu, got %g",
                           mesh->vertex_count - 1, index);
            return false;
        }
        mesh->triangles[i / 3][i % 3] = (uint32_t)index;
    }
    return true;
}

/* A list that is absent, or has one value for each point; otherwise it is left out, reported.
 * pbrt-v3 has room for texture coordinates that are too many. */
static const double *read_for_points(struct importer *importer, const struct statement *statement,
                                     const char *name, size_t width, size_t points)
{
    size_t count;
    const double *list = statement_list(importer, statement, name, width, &count);
    if (!list || count == points)
        return list;
    struct place place = statement_place(statement, statement_find(statement, name));
    if (count > points && width == 2 && importer->version == 3) {
        importer_warn(importer, place.origin, place.width,
                      "%s: those past the last point are left out", name);
        return list;
    }
    importer_error(importer, place.origin, place.width,
                   "%s: expected %zu values, one for each point, got %zu", name, points, count);
    return NULL;
}

static void copy_vectors(const double *from, size_t count, struct vector *to)
{
    for (size_t i = 0; i < count; i++)
        to[i] = (struct vector){from[3 * i], from[3 * i + 1], from[3 * i + 2]};
}

/* False: reported. */
static bool read_mesh(struct importer *importer, const struct statement *statement, bool attributes,
                      struct mesh *mesh)
{
    static const double one_triangle[] = {0, 1, 2};
    size_t points, count;
    const double *p = statement_list(importer, statement, "P", 3, &points);
    const double *indices = statement_list(importer, statement, "indices", 1, &count);
    const double *n = NULL, *uv = NULL;
    if (!p || points < 3 || points > UINT32_MAX / 2) {
        importer_error(importer, &statement->origin, statement->width,
                       "Shape %s: expected 3 or more points \"P\"", statement->kind);
        return false;
    }
    if (!indices && points == 3) {
        indices = one_triangle;
        count = 3;
    }
    if (!indices || count < 3 || count % 3 != 0 || count / 3 > MESH_TRIANGLES_LIMIT) {
        importer_error(importer, &statement->origin, statement->width,
                       "Shape %s: expected \"integer indices\", three for each triangle",
                       statement->kind);
        return false;
    }
    if (attributes) {
        n = read_for_points(importer, statement, "N", 3, points);
        uv = read_for_points(importer, statement, "uv", 2, points);
        uv = uv ? uv : read_for_points(importer, statement, "st", 2, points);
    }
    if (!mesh_allocate(mesh, points, n != NULL, uv != NULL, count / 3))
        return importer_no_memory(importer);
    copy_vectors(p, points, mesh->points);
    if (n)
        copy_vectors(n, points, mesh->normals);
    if (uv)
        memcpy(mesh->uv, uv, points * sizeof *mesh->uv);
    return read_indices(importer, statement, indices, mesh);
}

void triangle_mesh_add(struct importer *importer, const struct statement *statement)
{
    static const char *const unused[] = {"S", "faceIndices"};
    struct mesh mesh = {0};
    statement_ignore(statement, unused, sizeof unused / sizeof unused[0]);
    if (read_mesh(importer, statement, true, &mesh))
        mesh_add(importer, statement, &mesh);
    mesh_release(&mesh);
}

void loop_subdivision_add(struct importer *importer, const struct statement *statement)
{
    struct mesh mesh = {0};
    const char *name =
        statement_find(statement, "levels") ? "levels" : "nlevels"; /* the latter in pbrt-v2 */
    long levels = statement_integer(importer, statement, name, 3, 0, 12);
    static const char *const unused[] = {"scheme"};
    statement_ignore(statement, unused, 1);
    if (read_mesh(importer, statement, false, &mesh) &&
        subdivision_refine(importer, statement, &mesh, levels))
        mesh_add(importer, statement, &mesh);
    mesh_release(&mesh);
}
