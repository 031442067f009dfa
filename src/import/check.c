/* check.c: faces and nodes of what assimp returned.
 *
 * Indices are checked since a wrong one need not crash: it can read what lies beside the vertices.
 * Splitting polygons is assimp's, follows indices without looking, and so comes after a check.
 */
#include "import/check.h"

#include <stdlib.h>

static ps_result complain(struct mesh_job *job, const char *what)
{
    return error_set(job->error, PS_ERROR_INVALID, "%s: %s", job->request->path, what);
}

/* --- faces
 * -------------------------------------------------------------------------------------- */

static ps_result check_mesh(struct mesh_job *job, const struct aiMesh *mesh, bool *has_polygons)
{
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        for (unsigned j = 0; j < face->mNumIndices; j++)
            if (face->mIndices[j] >= mesh->mNumVertices)
                return complain(job, "a face has a vertex that the file lacks");
        *has_polygons |= face->mNumIndices > 3;
    }
    return PS_OK;
}

/* assimp leaves out glTF's triangles of vertices that are not there. */
static void count_left_out(struct mesh_job *job)
{
    size_t triangles = 0;
    for (unsigned i = 0; i < job->scene->mNumMeshes; i++)
        for (unsigned j = 0; j < job->scene->mMeshes[i]->mNumFaces; j++)
            triangles += job->scene->mMeshes[i]->mFaces[j].mNumIndices == 3;
    if (job->gltf.triangle_count > triangles)
        job->report->dropped_triangles = job->gltf.triangle_count - triangles;
}

ps_result mesh_check_faces(struct mesh_job *job, bool *has_polygons)
{
    const struct aiScene *scene = job->scene;
    size_t vertices = 0, faces = 0;
    *has_polygons = false;
    for (unsigned i = 0; i < scene->mNumMeshes; i++) {
        vertices += scene->mMeshes[i]->mNumVertices;
        faces += scene->mMeshes[i]->mNumFaces;
        if (vertices > MESH_TRIANGLES || faces > MESH_TRIANGLES)
            return complain(job, "more than 200 million vertices or triangles");
        ps_result result = check_mesh(job, scene->mMeshes[i], has_polygons);
        if (result != PS_OK)
            return result;
    }
    count_left_out(job);
    return PS_OK;
}

/* --- nodes
 * -------------------------------------------------------------------------------------- */

static struct affine affine_of_matrix(const struct aiMatrix4x4 *m)
{
    return (struct affine){
        {m->a1, m->b1, m->c1}, {m->a2, m->b2, m->c2}, {m->a3, m->b3, m->c3}, {m->a4, m->b4, m->c4}};
}

static size_t count_nodes(const struct aiNode *node)
{
    size_t count = 1;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        count += count_nodes(node->mChildren[i]);
    return count;
}

static void list_nodes(struct mesh_job *job, const struct aiNode *node, const struct affine *parent)
{
    struct affine own = affine_of_matrix(&node->mTransformation);
    struct mesh_node entry = {node, affine_compose(parent, &own)};
    job->nodes[job->node_count++] = entry;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        list_nodes(job, node->mChildren[i], &entry.to_file);
}

ps_result mesh_list_nodes(struct mesh_job *job)
{
    const struct affine identity = AFFINE_IDENTITY;
    size_t made_by_assimp = job->gltf.single_root ? 0 : 1;
    if (!job->scene->mRootNode)
        return complain(job, "there is no root node");
    size_t count = count_nodes(job->scene->mRootNode);
    if (job->gltf.root && count != job->gltf.node_count + made_by_assimp)
        return complain(job, "not all of the nodes were read");
    job->nodes = malloc(count * sizeof *job->nodes);
    if (!job->nodes)
        return mesh_out_of_memory(job, count * sizeof *job->nodes);
    list_nodes(job, job->scene->mRootNode, &identity);
    return PS_OK;
}
