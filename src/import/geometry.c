/* geometry.c: the triangles of one of assimp's meshes that are any good. */
#include "import/geometry.h"

#include <stdlib.h>
#include <string.h>

/* Height over longest edge below which a triangle has no area: float coordinates give no normal. */
#define FLATNESS 1e-10

/* Where the square of a normal's length leaves the range of floats, in which it is computed later:
 * edges below about 1e-9 and above 1e9. */
#define LEAST_SQUARE 1e-36
#define LARGEST_SQUARE 1e37

/* Neither where a number is not finite: no comparison with NaN holds, nor infinity < a limit. */
bool mesh_has_area(ps_vec3 a, ps_vec3 b, ps_vec3 c)
{
    double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    double v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    double vv = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    double edge = uu > vv ? uu : vv;
    return sqrt(nn) > FLATNESS * edge && nn > LEAST_SQUARE && nn < LARGEST_SQUARE;
}

static bool is_good_triangle(const struct aiMesh *mesh, const struct aiFace *face)
{
    ps_vec3 p[3];
    for (int i = 0; i < 3; i++)
        p[i] = mesh_vector(mesh->mVertices[face->mIndices[i]]);
    return mesh_has_area(p[0], p[1], p[2]);
}

/* Good triangles in their order; counts the others. */
static size_t collect_triangles(const struct aiMesh *mesh, uint32_t (*triangles)[3],
                                size_t *dropped)
{
    size_t count = 0;
    *dropped = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices < 3)
            continue; /* a point or a line */
        if (!is_good_triangle(mesh, face)) {
            (*dropped)++;
            continue;
        }
        for (int k = 0; k < 3; k++)
            triangles[count][k] = face->mIndices[k];
        count++;
    }
    return count;
}

size_t mesh_number_vertices(struct mesh_description *mesh, uint32_t *numbers, size_t old_count)
{
    size_t count = 0;
    memset(numbers, 0, old_count * sizeof *numbers);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            numbers[mesh->triangles[i][k]] = 1;
    for (size_t i = 0; i < old_count; i++)
        numbers[i] = numbers[i] ? (uint32_t)count++ : UINT32_MAX;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[i][k] = numbers[mesh->triangles[i][k]];
    return count;
}

static void fill_vectors(const struct aiVector3D *source, size_t count, const uint32_t *new_indices,
                         ps_vec3 *filled)
{
    for (size_t i = 0; i < count; i++)
        if (new_indices[i] != UINT32_MAX)
            filled[new_indices[i]] = mesh_vector(source[i]);
}

static void fill_uv(const struct aiMesh *source, unsigned set, const uint32_t *new_indices,
                    float (*filled)[2])
{
    for (unsigned i = 0; i < source->mNumVertices; i++) {
        const struct aiVector3D uv = source->mTextureCoords[set][i];
        if (new_indices[i] == UINT32_MAX)
            continue;
        filled[new_indices[i]][0] = isfinite(uv.x) ? uv.x : 0.0f;
        filled[new_indices[i]][1] = isfinite(uv.y) ? uv.y : 0.0f;
    }
}

static ps_vec3 face_normal(const struct mesh_description *mesh, const uint32_t triangle[3])
{
    ps_vec3 a = mesh->vertices[triangle[0]];
    return ps_normalize(ps_cross(ps_subtract(mesh->vertices[triangle[1]], a),
                                 ps_subtract(mesh->vertices[triangle[2]], a)));
}

static bool is_normal(ps_vec3 n)
{
    float square = ps_dot(n, n);
    return isfinite(square) && square > 0;
}

/* A corner without a normal of its own gets that of its triangle. */
static void mend_normals(struct mesh_description *mesh)
{
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            ps_vec3 *normal = &mesh->normals[mesh->triangles[i][k]];
            if (!is_normal(*normal))
                *normal = face_normal(mesh, mesh->triangles[i]);
        }
}

ps_result mesh_settle_normals(struct mesh_job *job, struct mesh_description *mesh)
{
    double angle = job->request->smooth_angle;
    ps_result result = PS_OK;
    if (!mesh->normals && angle > 0)
        result = mesh_smooth_by_angle(job, mesh, angle);
    if (result == PS_OK && mesh->normals)
        mend_normals(mesh);
    return result;
}

ps_result mesh_allocate_vertices(struct mesh_job *job, struct mesh_description *mesh, size_t count,
                                 const struct mesh_parts *parts)
{
    mesh->vertex_count = count;
    mesh->vertices = malloc(count * sizeof *mesh->vertices);
    mesh->normals = parts->normals ? malloc(count * sizeof *mesh->normals) : NULL;
    mesh->uv = parts->uv ? malloc(count * sizeof *mesh->uv) : NULL;
    mesh->second_uv = parts->second_uv ? malloc(count * sizeof *mesh->second_uv) : NULL;
    mesh->colors = parts->colors ? malloc(count * sizeof *mesh->colors) : NULL;
    bool good = mesh->vertices && (mesh->normals || !parts->normals) && (mesh->uv || !parts->uv) &&
                (mesh->second_uv || !parts->second_uv) && (mesh->colors || !parts->colors);
    return good ? PS_OK : mesh_out_of_memory(job, count * sizeof *mesh->vertices);
}

/* STL's normals are those of its triangles, or zero. */
static bool has_normals(const struct mesh_job *job, const struct aiMesh *source)
{
    return source->mNormals && job->format != FORMAT_STL;
}

ps_result mesh_fill(struct mesh_job *job, const struct mesh_geometry *geometry,
                    struct mesh_description *mesh, size_t *dropped)
{
    const struct aiMesh *source = geometry->mesh;
    uint32_t *new_indices = geometry->scratch;
    mesh->triangles = malloc(((size_t)source->mNumFaces + 1) * sizeof *mesh->triangles);
    if (!mesh->triangles)
        return mesh_out_of_memory(job, source->mNumFaces * sizeof *mesh->triangles);
    mesh->triangle_count = collect_triangles(source, mesh->triangles, dropped);
    size_t count = mesh_number_vertices(mesh, new_indices, source->mNumVertices);
    const struct mesh_parts parts = {
        .normals = has_normals(job, source),
        .uv = source->mTextureCoords[0] != NULL,
        .second_uv = geometry->second_uv && source->mTextureCoords[1] != NULL,
        .colors = geometry->colors,
    };
    if (count == 0)
        return PS_OK;
    ps_result result = mesh_allocate_vertices(job, mesh, count, &parts);
    if (result != PS_OK)
        return result;
    fill_vectors(source->mVertices, source->mNumVertices, new_indices, mesh->vertices);
    if (parts.normals)
        fill_vectors(source->mNormals, source->mNumVertices, new_indices, mesh->normals);
    if (parts.uv)
        fill_uv(source, 0, new_indices, mesh->uv);
    if (parts.second_uv)
        fill_uv(source, 1, new_indices, mesh->second_uv);
    if (parts.colors)
        mesh_fill_colors(job, geometry, new_indices, mesh->colors);
    return mesh_settle_normals(job, mesh);
}
