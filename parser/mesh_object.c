/* mesh_object.c: each of assimp's meshes once, and an object for each node that has it.
 *
 * A placement that mirrors turns a triangle's winding, and with it the front side, inside out: such
 * objects get a twin of the mesh, with winding and normals reversed, so that the front stays in front
 * (glTF 2, 3.7.4 "negative determinant").
 */
#include "parser/mesh_job.h"
#include <stdlib.h>
#include <string.h>

/* Height over longest edge below which a triangle has no area: float coordinates give no normal. */
#define FLATNESS 1e-10

/* Where the square of a normal's length leaves the range of floats, in which it is computed later:
 * edges below about 1e-9 and above 1e9. */
#define LEAST_SQUARE 1e-36
#define LARGEST_SQUARE 1e37

/* In place of a mesh's index: known to have no good triangle. */
#define EMPTY (NO_INDEX - 1)

struct builder {
    struct mesh_job *job;
    ps_vec3 **smooth;      /* of mesh_smooth_normals */
    size_t (*twins)[2];    /* for each of assimp's meshes, plain and mirrored; NO_INDEX, EMPTY */
    size_t *dropped;       /* triangles of each of assimp's meshes */
    uint32_t *new_indices; /* of the vertices of the mesh in work */
};

static const struct aiMesh *source_mesh(const struct builder *builder, size_t index)
{
    return builder->job->scene->mMeshes[index];
}

static bool has_area(ps_vec3 a, ps_vec3 b, ps_vec3 c)
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
    for (int i = 0; i < 3; i++) {
        p[i] = mesh_vector(mesh->mVertices[face->mIndices[i]]);
        if (!mesh_is_finite(p[i]))
            return false;
    }
    return has_area(p[0], p[1], p[2]);
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

/* Numbers the vertices in use, in their order, and renames them in the triangles. */
static size_t compact(struct mesh_description *mesh, uint32_t *new_indices, size_t old_count)
{
    size_t count = 0;
    memset(new_indices, 0, old_count * sizeof *new_indices);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            new_indices[mesh->triangles[i][k]] = 1;
    for (size_t i = 0; i < old_count; i++)
        new_indices[i] = new_indices[i] ? (uint32_t)count++ : UINT32_MAX;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[i][k] = new_indices[mesh->triangles[i][k]];
    return count;
}

static void fill_uv(const struct aiMesh *source, const uint32_t *new_indices,
                    struct mesh_description *mesh)
{
    for (unsigned i = 0; i < source->mNumVertices; i++) {
        const struct aiVector3D uv = source->mTextureCoords[0][i];
        if (new_indices[i] == UINT32_MAX)
            continue;
        mesh->uv[new_indices[i]][0] = isfinite(uv.x) ? uv.x : 0.0f;
        mesh->uv[new_indices[i]][1] = isfinite(uv.y) ? uv.y : 0.0f;
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

static void fill_normals(const struct aiMesh *source, const ps_vec3 *smooth,
                         const uint32_t *new_indices, struct mesh_description *mesh)
{
    for (unsigned i = 0; i < source->mNumVertices; i++)
        if (new_indices[i] != UINT32_MAX)
            mesh->normals[new_indices[i]] = smooth ? smooth[i] : mesh_vector(source->mNormals[i]);
    mend_normals(mesh);
}

/* STL's normals are those of its triangles, or zero. */
static bool has_normals(const struct builder *builder, size_t index)
{
    return (source_mesh(builder, index)->mNormals && builder->job->format != FORMAT_STL) ||
           (builder->smooth && builder->smooth[index]);
}

static bool allocate_vertices(struct mesh_description *mesh, size_t count, bool normals, bool uv)
{
    mesh->vertex_count = count;
    mesh->vertices = malloc(count * sizeof *mesh->vertices);
    mesh->normals = normals ? malloc(count * sizeof *mesh->normals) : NULL;
    mesh->uv = uv ? malloc(count * sizeof *mesh->uv) : NULL;
    return mesh->vertices && (mesh->normals || !normals) && (mesh->uv || !uv);
}

static ps_result fill_mesh(struct builder *builder, size_t index, struct mesh_description *mesh)
{
    const struct aiMesh *source = source_mesh(builder, index);
    mesh->triangles = malloc(((size_t)source->mNumFaces + 1) * sizeof *mesh->triangles);
    if (!mesh->triangles)
        return mesh_out_of_memory(builder->job, source->mNumFaces * sizeof *mesh->triangles);
    mesh->triangle_count = collect_triangles(source, mesh->triangles, &builder->dropped[index]);
    size_t count = compact(mesh, builder->new_indices, source->mNumVertices);
    bool normals = has_normals(builder, index), uv = source->mTextureCoords[0] != NULL;
    if (count == 0)
        return PS_OK;
    if (!allocate_vertices(mesh, count, normals, uv))
        return mesh_out_of_memory(builder->job, count * sizeof *mesh->vertices);
    for (unsigned i = 0; i < source->mNumVertices; i++)
        if (builder->new_indices[i] != UINT32_MAX)
            mesh->vertices[builder->new_indices[i]] = mesh_vector(source->mVertices[i]);
    if (uv)
        fill_uv(source, builder->new_indices, mesh);
    if (normals)
        fill_normals(source, builder->smooth ? builder->smooth[index] : NULL, builder->new_indices,
                     mesh);
    return PS_OK;
}

static void turn_inside_out(struct mesh_description *mesh)
{
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t second = mesh->triangles[i][1];
        mesh->triangles[i][1] = mesh->triangles[i][2];
        mesh->triangles[i][2] = second;
    }
    for (size_t i = 0; mesh->normals && i < mesh->vertex_count; i++)
        mesh->normals[i] = ps_scale(mesh->normals[i], -1.0f);
}

/* The mesh in the fragment, made when it is first wanted; or EMPTY. */
static ps_result want_mesh(struct builder *builder, size_t index, bool mirrored, size_t *mesh)
{
    struct scene_description *fragment = builder->job->fragment;
    *mesh = builder->twins[index][mirrored];
    if (*mesh != NO_INDEX)
        return PS_OK;
    struct mesh_description *made = &fragment->meshes[fragment->mesh_count++];
    ps_result result = fill_mesh(builder, index, made);
    if (result == PS_OK && made->triangle_count > 0) {
        if (mirrored)
            turn_inside_out(made);
        *mesh = builder->twins[index][mirrored] = fragment->mesh_count - 1;
    } else if (result == PS_OK) {
        free(made->triangles);
        *made = (struct mesh_description){0};
        fragment->mesh_count--;
        *mesh = builder->twins[index][mirrored] = EMPTY;
    }
    return result;
}

static void add_object(const struct builder *builder, const struct aiMesh *source, size_t mesh,
                       const struct affine *placement)
{
    struct mesh_job *job = builder->job;
    struct object_description *object = &job->fragment->objects[job->fragment->object_count++];
    *object = (struct object_description){
        .kind = OBJECT_MESH,
        .material = source->mMaterialIndex < job->scene->mNumMaterials
                        ? job->materials[source->mMaterialIndex]
                        : NO_INDEX,
        .transform = {.scale = {1, 1, 1}},
        .placement = *placement,
        .texture = NO_INDEX,
        .mesh = mesh,
        .group = NO_INDEX,
        .origin = job->request->origin,
    };
}

static size_t count_triangles(const struct aiMesh *mesh)
{
    size_t count = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        count += mesh->mFaces[i].mNumIndices == 3;
    return count;
}

static ps_result place_mesh(struct builder *builder, size_t index, const struct affine *placement)
{
    const struct aiMesh *source = source_mesh(builder, index);
    float determinant = affine_determinant(placement);
    size_t mesh;
    if (!isfinite(determinant) || !(fabsf(determinant) > 0) ||
        !mesh_is_finite(placement->translation)) {
        builder->job->report->dropped_triangles += count_triangles(source);
        return PS_OK;
    }
    ps_result result = want_mesh(builder, index, determinant < 0, &mesh);
    if (result == PS_OK && mesh != EMPTY)
        add_object(builder, source, mesh, placement);
    return result;
}

static ps_result place_all(struct builder *builder)
{
    const struct mesh_job *job = builder->job;
    ps_result result = PS_OK;
    for (size_t i = 0; i < job->node_count; i++) {
        const struct aiNode *node = job->nodes[i].node;
        struct affine placement = mesh_node_placement(job, &job->nodes[i]);
        for (unsigned j = 0; result == PS_OK && j < node->mNumMeshes; j++)
            result = place_mesh(builder, node->mMeshes[j], &placement);
    }
    for (unsigned i = 0; i < job->scene->mNumMeshes; i++)
        job->report->dropped_triangles += builder->dropped[i];
    return result;
}

static size_t count_pairs(const struct mesh_job *job)
{
    size_t count = 0;
    for (size_t i = 0; i < job->node_count; i++)
        count += job->nodes[i].node->mNumMeshes;
    return count;
}

static size_t largest_mesh(const struct mesh_job *job)
{
    size_t largest = 0;
    for (unsigned i = 0; i < job->scene->mNumMeshes; i++)
        if (job->scene->mMeshes[i]->mNumVertices > largest)
            largest = job->scene->mMeshes[i]->mNumVertices;
    return largest;
}

static ps_result prepare(struct builder *builder)
{
    struct scene_description *fragment = builder->job->fragment;
    size_t meshes = builder->job->scene->mNumMeshes, pairs = count_pairs(builder->job);
    fragment->meshes = calloc(2 * meshes + 1, sizeof *fragment->meshes);
    fragment->objects = calloc(pairs + 1, sizeof *fragment->objects);
    builder->twins = malloc((meshes + 1) * sizeof *builder->twins);
    builder->dropped = calloc(meshes + 1, sizeof *builder->dropped);
    builder->new_indices = malloc((largest_mesh(builder->job) + 1) * sizeof(uint32_t));
    if (!fragment->meshes || !fragment->objects || !builder->twins || !builder->dropped ||
        !builder->new_indices)
        return mesh_out_of_memory(builder->job, pairs * sizeof *fragment->objects);
    for (size_t i = 0; i < meshes; i++)
        builder->twins[i][0] = builder->twins[i][1] = NO_INDEX;
    return mesh_smooth_normals(builder->job, &builder->smooth);
}

ps_result mesh_read_objects(struct mesh_job *job)
{
    struct builder builder = {.job = job};
    ps_result result = prepare(&builder);
    if (result == PS_OK)
        result = place_all(&builder);
    if (result == PS_OK && job->fragment->object_count == 0)
        result = error_set(job->error, PS_ERROR_INVALID, "%s: the file has no triangles",
                           job->request->path);
    mesh_smooth_release(job, builder.smooth);
    free(builder.twins);
    free(builder.dropped);
    free(builder.new_indices);
    return result;
}
