/* check.c: what assimp returned, before anything is made of it.
 *
 * Counts, pointers and indices are checked here once; what follows relies on it. Splitting polygons
 * is assimp's, and comes in the middle, since it follows indices without looking.
 */
#include "import/job.h"
#include <stdlib.h>

static ps_result complain(struct mesh_job *job, const char *what)
{
    return error_set(job->error, PS_ERROR_INVALID, "%s: %s", job->request->path, what);
}

/* --- nodes -------------------------------------------------------------------------------------- */

static struct affine affine_of_matrix(const struct aiMatrix4x4 *m)
{
    return (struct affine){
        {m->a1, m->b1, m->c1}, {m->a2, m->b2, m->c2}, {m->a3, m->b3, m->c3}, {m->a4, m->b4, m->c4}};
}

static ps_result count_nodes(struct mesh_job *job, const struct aiNode *node, int depth)
{
    if (depth > GLTF_DEPTH)
        return complain(job, "nodes are nested more than 256 deep");
    if (++job->node_count > GLTF_NODES + 1)
        return complain(job, "more than 1000000 nodes");
    if ((node->mNumChildren > 0 && !node->mChildren) || (node->mNumMeshes > 0 && !node->mMeshes))
        return complain(job, "a node without its parts");
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (node->mMeshes[i] >= job->scene->mNumMeshes)
            return complain(job, "a node has a mesh that the file lacks");
    ps_result result = PS_OK;
    for (unsigned i = 0; result == PS_OK && i < node->mNumChildren; i++)
        result = node->mChildren[i] ? count_nodes(job, node->mChildren[i], depth + 1)
                                    : complain(job, "a node without a child it names");
    return result;
}

static void list_nodes(struct mesh_job *job, const struct aiNode *node, const struct affine *parent)
{
    struct affine own = affine_of_matrix(&node->mTransformation);
    struct mesh_node entry = {node, affine_compose(parent, &own)};
    job->nodes[job->node_count++] = entry;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        list_nodes(job, node->mChildren[i], &entry.to_file);
}

static ps_result check_nodes(struct mesh_job *job)
{
    const struct affine identity = AFFINE_IDENTITY;
    size_t made_by_assimp = job->gltf.single_root ? 0 : 1;
    if (!job->scene->mRootNode)
        return complain(job, "there is no root node");
    job->node_count = 0;
    ps_result result = count_nodes(job, job->scene->mRootNode, 1);
    if (result != PS_OK)
        return result;
    if (job->gltf.root && job->node_count != job->gltf.node_count + made_by_assimp)
        return complain(job, "not all of the nodes were read");
    job->nodes = malloc(job->node_count * sizeof *job->nodes);
    if (!job->nodes)
        return mesh_out_of_memory(job, job->node_count * sizeof *job->nodes);
    job->node_count = 0;
    list_nodes(job, job->scene->mRootNode, &identity);
    return PS_OK;
}

/* --- meshes ------------------------------------------------------------------------------------- */

static ps_result check_faces(struct mesh_job *job, const struct aiMesh *mesh, bool *has_polygons)
{
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices > 0 && !face->mIndices)
            return complain(job, "a face without its corners");
        for (unsigned j = 0; j < face->mNumIndices; j++)
            if (face->mIndices[j] >= mesh->mNumVertices)
                return complain(job, "a face has a vertex that the file lacks");
        *has_polygons |= face->mNumIndices > 3;
    }
    return PS_OK;
}

static ps_result check_meshes(struct mesh_job *job, bool *has_polygons)
{
    const struct aiScene *scene = job->scene;
    size_t vertices = 0, faces = 0;
    *has_polygons = false;
    if (scene->mNumMeshes > 0 && !scene->mMeshes)
        return complain(job, "meshes are missing");
    for (unsigned i = 0; i < scene->mNumMeshes; i++) {
        const struct aiMesh *mesh = scene->mMeshes[i];
        if (!mesh || (mesh->mNumVertices > 0 && !mesh->mVertices) ||
            (mesh->mNumFaces > 0 && !mesh->mFaces))
            return complain(job, "a mesh without its parts");
        vertices += mesh->mNumVertices;
        faces += mesh->mNumFaces;
        if (vertices > MESH_TRIANGLES || faces > MESH_TRIANGLES)
            return complain(job, "more than 200 million vertices or triangles");
        ps_result result = check_faces(job, mesh, has_polygons);
        if (result != PS_OK)
            return result;
    }
    return PS_OK;
}

/* --- the rest ----------------------------------------------------------------------------------- */

static ps_result check_lists(struct mesh_job *job)
{
    const struct aiScene *scene = job->scene;
    if ((scene->mNumMaterials > 0 && !scene->mMaterials) ||
        (scene->mNumCameras > 0 && !scene->mCameras) ||
        (scene->mNumLights > 0 && !scene->mLights) ||
        (scene->mNumTextures > 0 && !scene->mTextures))
        return complain(job, "materials, cameras, lights or textures are missing");
    for (unsigned i = 0; i < scene->mNumMaterials; i++)
        if (!scene->mMaterials[i])
            return complain(job, "a material is missing");
    for (unsigned i = 0; i < scene->mNumCameras; i++)
        if (!scene->mCameras[i])
            return complain(job, "a camera is missing");
    for (unsigned i = 0; i < scene->mNumLights; i++)
        if (!scene->mLights[i])
            return complain(job, "a light is missing");
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
        job->report->dropped_triangles += job->gltf.triangle_count - triangles;
}

ps_result mesh_check_scene(struct mesh_job *job)
{
    bool has_polygons;
    ps_result result = check_lists(job);
    if (result == PS_OK)
        result = check_meshes(job, &has_polygons);
    if (result == PS_OK && has_polygons) {
        result = mesh_source_triangulate(job);
        if (result == PS_OK)
            result = check_meshes(job, &has_polygons);
    }
    if (result == PS_OK)
        count_left_out(job);
    return result == PS_OK ? check_nodes(job) : result;
}
