/* object.c: each of assimp's meshes once, and an object for each node that has it.
 *
 * Where a placement mirrors, shapes keep the front in front (src/scene/shape.h), as glTF 2 wants it
 * (3.7.4, "negative determinant").
 */
#include "import/geometry.h"
#include "import/instances.h"
#include "import/material.h"
#include "import/steps.h"
#include <stdlib.h>
#include <string.h>

/* In place of a mesh's index: known to have no good triangle. */
#define EMPTY (NO_INDEX - 1)

struct builder {
    struct mesh_job *job;
    ps_vec3 **smooth;  /* of mesh_smooth_normals */
    size_t *meshes;    /* of the fragment, for each of assimp's; NO_INDEX: not yet; EMPTY */
    size_t *dropped;   /* triangles of each of assimp's meshes */
    uint32_t *scratch; /* room for a number for each vertex of any mesh */
    size_t object_capacity;
};

static const struct aiMesh *source_mesh(const struct builder *builder, size_t index)
{
    return builder->job->scene->mMeshes[index];
}

static const ps_vec3 *smooth_of(const struct builder *builder, size_t index)
{
    return builder->smooth ? builder->smooth[index] : NULL;
}

/* The fragment's; NULL for a material that is not there. */
static size_t *material_of(const struct builder *builder, const struct aiMesh *source)
{
    struct mesh_job *job = builder->job;
    return source->mMaterialIndex < job->scene->mNumMaterials
               ? &job->materials[source->mMaterialIndex]
               : NULL;
}

/* With what its material looks up. */
static struct mesh_geometry geometry_of(const struct builder *builder, size_t index)
{
    struct mesh_job *job = builder->job;
    const struct aiMesh *mesh = source_mesh(builder, index);
    const size_t *material = material_of(builder, mesh);
    struct mesh_geometry geometry = {
        .mesh = mesh,
        .primitive = gltf_primitive(&job->gltf, index, job->scene->mNumMeshes),
        .second_uv =
            material && *material != NO_INDEX && mesh_material_has_second_uv(job, *material),
        .smooth = smooth_of(builder, index),
        .scratch = builder->scratch,
    };
    geometry.colors = material && job->request->materials && mesh_has_colors(job, &geometry);
    return geometry;
}

/* The mesh in the fragment, made when it is first wanted; or EMPTY. */
static ps_result want_mesh(struct builder *builder, size_t index, size_t *mesh)
{
    struct scene_description *fragment = builder->job->fragment;
    *mesh = builder->meshes[index];
    if (*mesh != NO_INDEX)
        return PS_OK;
    struct mesh_description *made = &fragment->meshes[fragment->mesh_count++];
    const struct mesh_geometry source = geometry_of(builder, index);
    ps_result result = mesh_fill(builder->job, &source, made, &builder->dropped[index]);
    if (result == PS_OK && made->colors)
        result = mesh_material_paint(builder->job, material_of(builder, source.mesh));
    if (result == PS_OK && made->triangle_count > 0) {
        *mesh = builder->meshes[index] = fragment->mesh_count - 1;
    } else if (result == PS_OK) {
        free(made->triangles);
        *made = (struct mesh_description){0};
        fragment->mesh_count--;
        *mesh = builder->meshes[index] = EMPTY;
    }
    return result;
}

static ps_result reserve_object(struct builder *builder)
{
    struct scene_description *fragment = builder->job->fragment;
    if (fragment->object_count < builder->object_capacity)
        return PS_OK;
    size_t capacity = 2 * builder->object_capacity + 16;
    size_t bytes = capacity * sizeof *fragment->objects;
    struct object_description *objects = realloc(fragment->objects, bytes);
    if (!objects)
        return mesh_out_of_memory(builder->job, bytes);
    fragment->objects = objects;
    builder->object_capacity = capacity;
    return PS_OK;
}

static ps_result add_object(struct builder *builder, const struct aiMesh *source, size_t mesh,
                            const struct affine *placement)
{
    struct mesh_job *job = builder->job;
    const size_t *material = material_of(builder, source);
    if (job->fragment->object_count == MESH_OBJECTS)
        return error_set(job->error, PS_ERROR_INVALID, "%s: it makes more than %d objects",
                         job->request->path, MESH_OBJECTS);
    ps_result result = reserve_object(builder);
    if (result != PS_OK)
        return result;
    struct object_description *object = &job->fragment->objects[job->fragment->object_count++];
    *object = (struct object_description){
        .kind = OBJECT_MESH,
        .material = material ? *material : NO_INDEX,
        .placement = *placement,
        .texture = NO_INDEX,
        .mesh = mesh,
        .group = NO_INDEX,
        .origin = job->request->origin,
    };
    return PS_OK;
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
    ps_result result = want_mesh(builder, index, &mesh);
    if (result == PS_OK && mesh != EMPTY)
        result = add_object(builder, source, mesh, placement);
    return result;
}

static ps_result place_node(struct builder *builder, const struct mesh_node *node,
                            const struct affine *placement)
{
    ps_result result = PS_OK;
    for (unsigned j = 0; result == PS_OK && j < node->node->mNumMeshes; j++)
        result = place_mesh(builder, node->node->mMeshes[j], placement);
    return result;
}

/* Its JSON has the instances of a node. */
static ps_result place_instances(struct builder *builder, size_t index)
{
    struct mesh_job *job = builder->job;
    const struct mesh_node *node = &job->nodes[index];
    const struct affine placement = mesh_node_placement(job, node);
    struct mesh_instances instances = {0};
    struct error reason;
    ps_result result = PS_OK;
    if (job->gltf.root && node->node->mNumMeshes > 0)
        result = mesh_read_instances(&job->gltf, mesh_gltf_node(job, index), node->node->mNumMeshes,
                                     &instances, &reason);
    if (result != PS_OK)
        return error_set(job->error, result, "%s: %.1000s", job->request->path, reason.text);
    if (!instances.present)
        return place_node(builder, node, &placement);
    for (size_t i = 0; result == PS_OK && i < instances.count; i++) {
        struct affine placed = affine_compose(&placement, &instances.placements[i]);
        result = place_node(builder, node, &placed);
    }
    return result;
}

static ps_result place_all(struct builder *builder)
{
    const struct mesh_job *job = builder->job;
    ps_result result = PS_OK;
    for (size_t i = 0; result == PS_OK && i < job->node_count; i++)
        result = place_instances(builder, i);
    for (unsigned i = 0; i < job->scene->mNumMeshes; i++)
        job->report->dropped_triangles += builder->dropped[i];
    return result;
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
    size_t meshes = builder->job->scene->mNumMeshes;
    fragment->meshes = calloc(meshes + 1, sizeof *fragment->meshes);
    builder->meshes = malloc((meshes + 1) * sizeof *builder->meshes);
    builder->dropped = calloc(meshes + 1, sizeof *builder->dropped);
    builder->scratch = malloc((largest_mesh(builder->job) + 1) * sizeof(uint32_t));
    if (!fragment->meshes || !builder->meshes || !builder->dropped || !builder->scratch)
        return mesh_out_of_memory(builder->job, meshes * sizeof *fragment->meshes);
    for (size_t i = 0; i < meshes; i++)
        builder->meshes[i] = NO_INDEX;
    return mesh_smooth_normals(builder->job, &builder->smooth);
}

ps_result mesh_read_objects(struct mesh_job *job)
{
    struct builder builder = {.job = job};
    ps_result result = prepare(&builder);
    mesh_check_colors(job);
    if (result == PS_OK)
        result = place_all(&builder);
    mesh_note_colors(job);
    if (result == PS_OK && job->fragment->object_count == 0)
        result = error_set(job->error, PS_ERROR_INVALID, "%s: the file has no triangles%s",
                           job->request->path,
                           job->gltf.draco ? ", or this assimp does not unpack Draco" : "");
    mesh_smooth_release(job, builder.smooth);
    free(builder.meshes);
    free(builder.dropped);
    free(builder.scratch);
    return result;
}
