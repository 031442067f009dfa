/* patch.c: bilinear patches and height fields as meshes.
 *
 * A patch has the corners p00, p10, p01, p11 in the order of its indices; flat ones become two
 * triangles, twisted ones a grid. A height field has z over x and y from 0 to 1, nu by nv numbers
 * "Pz" with x the faster (pbrt-v3).
 */
#include "pbrt/shape.h"

#include <math.h>
#include <string.h>

#define PIECES 8 /* of a twisted patch, along a side */
#define PATCH_VERTICES ((PIECES + 1) * (PIECES + 1))

static struct vector corner(const double *p, double index)
{
    const double *at = p + 3 * (size_t)index;
    return (struct vector){at[0], at[1], at[2]};
}

static double blend(const double values[4], double u, double v)
{
    return (1 - v) * ((1 - u) * values[0] + u * values[1]) +
           v * ((1 - u) * values[2] + u * values[3]);
}

static struct vector blend_vectors(const struct vector c[4], double u, double v)
{
    return (struct vector){blend((const double[4]){c[0].x, c[1].x, c[2].x, c[3].x}, u, v),
                           blend((const double[4]){c[0].y, c[1].y, c[2].y, c[3].y}, u, v),
                           blend((const double[4]){c[0].z, c[1].z, c[2].z, c[3].z}, u, v)};
}

static struct vector patch_point(const void *user, double u, double v)
{
    return blend_vectors(user, u, v);
}

static bool is_flat(const struct vector c[4])
{
    struct vector a = vector_subtract(c[1], c[0]), b = vector_subtract(c[2], c[0]),
                  d = vector_subtract(c[3], c[0]);
    double size = vector_length(a) * vector_length(b) * vector_length(d);
    return fabs(vector_dot(vector_cross(a, b), d)) <= 1e-6 * size;
}

/* What the file gives for the points of a patch. */
struct patches {
    const double *p, *n, *uv, *indices;
    size_t count;
};

/* Adds one patch to the mesh, whose counts grow. False: reported. */
static bool add_patch(struct importer *importer, const struct patches *from, size_t patch,
                      struct mesh *mesh)
{
    const double *indices = from->indices + 4 * patch;
    struct vector corners[4], normals[4] = {{0}};
    for (int k = 0; k < 4; k++) {
        corners[k] = corner(from->p, indices[k]);
        if (from->n)
            normals[k] = corner(from->n, indices[k]);
    }
    size_t pieces = is_flat(corners) ? 1 : PIECES;
    const struct surface_function surface = {patch_point, corners, pieces, pieces};
    struct mesh piece;
    if (!mesh_from_surface(&surface, &piece))
        return importer_no_memory(importer);
    for (size_t i = 0; i < piece.vertex_count; i++) {
        double u = piece.uv[i][0], v = piece.uv[i][1], *uv = mesh->uv[mesh->vertex_count + i];
        mesh->points[mesh->vertex_count + i] = piece.points[i];
        mesh->normals[mesh->vertex_count + i] =
            from->n ? blend_vectors(normals, u, v) : piece.normals[i];
        for (int axis = 0; axis < 2; axis++) {
            double values[4];
            for (int k = 0; k < 4; k++)
                values[k] = from->uv ? from->uv[2 * (size_t)indices[k] + (size_t)axis] : 0.0;
            uv[axis] = from->uv ? blend(values, u, v) : piece.uv[i][axis];
        }
    }
    for (size_t i = 0; i < piece.triangle_count; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[mesh->triangle_count + i][k] =
                piece.triangles[i][k] + (uint32_t)mesh->vertex_count;
    mesh->vertex_count += piece.vertex_count;
    mesh->triangle_count += piece.triangle_count;
    mesh_release(&piece);
    return true;
}

/* False: reported. */
static bool read_patches(struct importer *importer, const struct statement *statement,
                         struct patches *patches)
{
    static const double one_patch[] = {0, 1, 2, 3};
    size_t points, count, normals, uvs;
    *patches = (struct patches){.p = statement_list(importer, statement, "P", 3, &points)};
    patches->n = statement_list(importer, statement, "N", 3, &normals);
    patches->uv = statement_list(importer, statement, "uv", 2, &uvs);
    patches->indices = statement_list(importer, statement, "indices", 1, &count);
    if (!patches->indices && points == 4) {
        patches->indices = one_patch;
        count = 4;
    }
    patches->count = count / 4;
    bool good = patches->p && patches->indices && count >= 4 && count % 4 == 0 &&
                patches->count <= MESH_TRIANGLES_LIMIT / (2 * PIECES * PIECES) &&
                (!patches->n || normals == points) && (!patches->uv || uvs == points);
    for (size_t i = 0; i < count && good; i++)
        good = patches->indices[i] >= 0.0 && patches->indices[i] < (double)points;
    if (!good)
        importer_error(importer, &statement->origin, statement->width,
                       "Shape bilinearmesh: expected points \"P\", four \"indices\" within them "
                       "for each patch, and as "
                       "many \"N\" and \"uv\" as points");
    return good;
}

void bilinear_mesh_add(struct importer *importer, const struct statement *statement)
{
    struct patches patches;
    struct mesh mesh = {0};
    static const char *const unused[] = {"faceIndices"};
    statement_ignore(statement, unused, 1);
    if (!read_patches(importer, statement, &patches))
        return;
    if (mesh_allocate(&mesh, patches.count * PATCH_VERTICES, true, true,
                      patches.count * 2 * PIECES * PIECES)) {
        bool good = true;
        mesh.vertex_count = mesh.triangle_count = 0;
        for (size_t i = 0; i < patches.count && good; i++)
            good = add_patch(importer, &patches, i, &mesh);
        if (good)
            mesh_add(importer, statement, &mesh);
    } else {
        importer_report_memory(importer);
    }
    mesh_release(&mesh);
}

void height_field_add(struct importer *importer, const struct statement *statement)
{
    long nu = statement_integer(importer, statement, "nu", 0, 0, 16384);
    long nv = statement_integer(importer, statement, "nv", 0, 0, 16384);
    size_t count, across = (size_t)nu, points = (size_t)nu * (size_t)nv;
    const double *z = statement_list(importer, statement, "Pz", 1, &count);
    struct mesh mesh = {0};
    if (!z || nu < 2 || nv < 2 || count != points || 2 * points > MESH_TRIANGLES_LIMIT) {
        importer_error(importer, &statement->origin, statement->width,
                       "Shape heightfield: expected integers \"nu\" and \"nv\" of 2 or more, and "
                       "nu nv floats \"Pz\"");
        return;
    }
    if (!mesh_allocate(&mesh, points, false, true, 2 * (across - 1) * ((size_t)nv - 1))) {
        importer_report_memory(importer);
        return;
    }
    size_t triangle = 0;
    for (size_t i = 0; i < points; i++) {
        size_t column = i % across, row = i / across;
        double u = (double)column / (double)(nu - 1), v = (double)row / (double)(nv - 1);
        mesh.points[i] = (struct vector){u, v, z[i]};
        mesh.uv[i][0] = u;
        mesh.uv[i][1] = v;
        if (column + 1 == across || row + 1 == (size_t)nv)
            continue;
        uint32_t a = (uint32_t)i, b = a + 1, c = b + (uint32_t)across, d = a + (uint32_t)across;
        memcpy(mesh.triangles[triangle++], (const uint32_t[3]){a, b, c}, sizeof *mesh.triangles);
        memcpy(mesh.triangles[triangle++], (const uint32_t[3]){a, c, d}, sizeof *mesh.triangles);
    }
    mesh_add(importer, statement, &mesh);
    mesh_release(&mesh);
}
