/* mesh.c: see mesh.h. */
#include "writer/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mesh of more becomes a file: it would be no text to read. So does each of many: a scene's text
 * has its limit. */
#define INLINE_TRIANGLES 64
#define INLINE_NUMBERS ((size_t)1500000) /* of all meshes in the text */

bool mesh_allocate(struct mesh *mesh, size_t vertices, bool normals, bool uv, size_t triangles)
{
    *mesh = (struct mesh){.vertex_count = vertices, .triangle_count = triangles};
    mesh->points = calloc(vertices + 1, sizeof *mesh->points);
    mesh->normals = normals ? calloc(vertices + 1, sizeof *mesh->normals) : NULL;
    mesh->uv = uv ? calloc(vertices + 1, sizeof *mesh->uv) : NULL;
    mesh->triangles = calloc(triangles + 1, sizeof *mesh->triangles);
    if (mesh->points && mesh->triangles && (mesh->normals || !normals) && (mesh->uv || !uv))
        return true;
    mesh_release(mesh);
    return false;
}

void mesh_release(struct mesh *mesh)
{
    free(mesh->points);
    free(mesh->normals);
    free(mesh->uv);
    free(mesh->triangles);
    *mesh = (struct mesh){0};
}

void mesh_reverse(struct mesh *mesh)
{
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t swapped = mesh->triangles[i][1];
        mesh->triangles[i][1] = mesh->triangles[i][2];
        mesh->triangles[i][2] = swapped;
    }
    for (size_t i = 0; i < mesh->vertex_count && mesh->normals; i++) {
        struct vector n = mesh->normals[i];
        mesh->normals[i] = (struct vector){-n.x, -n.y, -n.z};
    }
}

static struct vector cross_of(const struct vector *points, const uint32_t triangle[3])
{
    struct vector a = points[triangle[0]];
    return vector_cross(vector_subtract(points[triangle[1]], a),
                        vector_subtract(points[triangle[2]], a));
}

double mesh_area(const struct mesh *mesh, const struct transform *placement)
{
    double area = 0.0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        struct vector corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = transform_point(placement, mesh->points[mesh->triangles[i][k]]);
        area += 0.5 * vector_length(cross_of(corners, (const uint32_t[3]){0, 1, 2}));
    }
    return area;
}

/* --- writing
 * -------------------------------------------------------------------------------------- */

static void put_vectors(FILE *out, const char *key, const struct vector *values, size_t count)
{
    fprintf(out, "%s: [", key);
    for (size_t i = 0; i < count; i++) {
        fputs(i > 0 ? ", " : "", out);
        put_vector(out, values[i]);
    }
    fputc(']', out);
}

static void put_inline(FILE *out, const struct mesh *mesh)
{
    fputs("  - triangles: {", out);
    put_vectors(out, "vertices", mesh->points, mesh->vertex_count);
    if (mesh->normals)
        put_vectors(out, ", normals", mesh->normals, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count && mesh->uv; i++) {
        fputs(i == 0 ? ", uv: [[" : ", [", out);
        put_number(out, mesh->uv[i][0]);
        fputs(", ", out);
        put_number(out, mesh->uv[i][1]);
        fputs(i + 1 == mesh->vertex_count ? "]]" : "]", out);
    }
    fputs(", triangles: [", out);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        fprintf(out, "%s[%u, %u, %u]", i > 0 ? ", " : "", mesh->triangles[i][0],
                mesh->triangles[i][1], mesh->triangles[i][2]);
    fputc(']', out);
}

/* Whether the mesh goes into the text, which is then counted. */
static bool fits_inline(struct scene_text *scene, const struct mesh *mesh)
{
    size_t numbers = 3 * mesh->triangle_count +
                     mesh->vertex_count * (3 + (mesh->normals ? 3u : 0u) + (mesh->uv ? 2u : 0u));
    if (mesh->triangle_count > INLINE_TRIANGLES || mesh->vertex_count > 3 * INLINE_TRIANGLES ||
        scene->inline_numbers + numbers > INLINE_NUMBERS)
        return false;
    scene->inline_numbers += numbers;
    return true;
}

void mesh_turn_to_normals(struct mesh *mesh)
{
    for (size_t i = 0; i < mesh->triangle_count && mesh->normals; i++) {
        uint32_t *t = mesh->triangles[i], swapped = t[1];
        struct vector n = cross_of(mesh->points, t), *m = mesh->normals;
        if (vector_dot(n, m[t[0]]) + vector_dot(n, m[t[1]]) + vector_dot(n, m[t[2]]) >= 0.0)
            continue;
        t[1] = t[2];
        t[2] = swapped;
    }
}

bool mesh_put(struct scene_text *scene, const char *base, FILE *out, const struct mesh *mesh)
{
    if (fits_inline(scene, mesh)) {
        put_inline(out, mesh);
        return true;
    }
    struct side_file *file = scene_text_file(scene, base, "mesh", "ply");
    if (file)
        file->bytes = mesh_to_ply(mesh, &file->size);
    if (!file || !file->bytes)
        return false;
    fputs("  - mesh: {file: ", out);
    put_path(out, file->name);
    fputs(", use: [geometry]", out);
    return true;
}
