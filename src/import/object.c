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

/* Sources of meshes are assimp's, the parts of an OBJ file, or all of a PLY file. */
struct builder {
    struct mesh_job *job;
    struct obj_filling *obj; /* OBJ: or NULL */
    size_t source_count;
    size_t *meshes;    /* of the fragment, for each source; NO_INDEX: not yet; EMPTY */
    size_t *dropped;   /* triangles of each source */
    uint32_t *scratch; /* room for a number for each vertex of any of assimp's meshes */
    size_t object_capacity;
};

static const struct obj_part *part_of(const struct builder *builder, size_t source)
{
    return &builder->job->obj.parts[source];
}

/* Of the outline of an OBJ file, that with the same material. */
static const struct aiMesh *source_mesh(const struct builder *builder, size_t source)
{
    if (builder->obj) {
        size_t material = part_of(builder, source)->material;
        source = material == NO_INDEX ? 0 : material + 1;
    }
    return builder->job->scene->mMeshes[source];
}

static size_t count_triangles(const struct builder *builder, size_t source)
{
    const struct aiMesh *mesh = source_mesh(builder, source);
    size_t count = 0;
    if (builder->obj)
        return part_of(builder, source)->count;
    if (builder->job->ply.is_read)
        return builder->job->ply.triangle_count;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        count += mesh->mFaces[i].mNumIndices == 3;
    return count;
}

/* The fragment's; NULL for a material that is not there. */
static size_t *material_of(const struct builder *builder, size_t source)
{
    struct mesh_job *job = builder->job;
    unsigned material = source_mesh(builder, source)->mMaterialIndex;
    return material < job->scene->mNumMaterials ? &job->materials[material] : NULL;
}

static ps_result fill_part(const struct builder *builder, size_t source,
                           struct mesh_description *made)
{
    const struct mesh_job *job = builder->job;
    const struct obj_part *part = part_of(builder, source);
    bool colors =
        material_of(builder, source) && job->request->materials && obj_has_colors(job, part);
    return obj_fill(builder->obj, part, colors, made, &builder->dropped[source]);
}

static ps_result fill_ply(const struct builder *builder, size_t source,
                          struct mesh_description *made)
{
    struct mesh_job *job = builder->job;
    bool colors = material_of(builder, source) && job->request->materials && ply_has_colors(job);
    return ply_fill(job, colors, made, &builder->dropped[source]);
}

/* With what its material looks up. */
static ps_result fill_mesh(const struct builder *builder, size_t source,
                           struct mesh_description *made)
{
    struct mesh_job *job = builder->job;
    const size_t *material = material_of(builder, source);
    struct mesh_geometry geometry = {
        .mesh = source_mesh(builder, source),
        .primitive = gltf_primitive(&job->gltf, source, job->scene->mNumMeshes),
        .second_uv =
            material && *material != NO_INDEX && mesh_material_has_second_uv(job, *material),
        .scratch = builder->scratch,
    };
    geometry.colors = material && job->request->materials && mesh_has_colors(job, &geometry);
    return mesh_fill(job, &geometry, made, &builder->dropped[source]);
}

/* The mesh in the fragment, made when it is first wanted; or EMPTY. */
static ps_result want_mesh(struct builder *builder, size_t source, size_t *mesh)
{
    struct scene_description *fragment = builder->job->fragment;
    *mesh = builder->meshes[source];
    if (*mesh != NO_INDEX)
        return PS_OK;
    struct mesh_description *made = &fragment->meshes[fragment->mesh_count++];
    ps_result result = builder->obj                ? fill_part(builder, source, made)
                       : builder->job->ply.is_read ? fill_ply(builder, source, made)
                                                   : fill_mesh(builder, source, made);
    if (result == PS_OK && made->colors)
        result = mesh_material_paint(builder->job, material_of(builder, source));
    if (result == PS_OK && made->triangle_count > 0) {
        *mesh = builder->meshes[source] = fragment->mesh_count - 1;
    } else if (result == PS_OK) {
        free(made->triangles);
        *made = (struct mesh_description){0};
        fragment->mesh_count--;
        *mesh = builder->meshes[source] = EMPTY;
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

static ps_result add_object(struct builder *builder, size_t source, size_t mesh,
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

static ps_result place_mesh(struct builder *builder, size_t source, const struct affine *placement)
{
    float determinant = affine_determinant(placement);
    size_t mesh;
    if (!isfinite(determinant) || !(fabsf(determinant) > 0) ||
        !mesh_is_finite(placement->translation)) {
        builder->job->report->dropped_triangles += count_triangles(builder, source);
        return PS_OK;
    }
    ps_result result = want_mesh(builder, source, &mesh);
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
    for (size_t i = 0; builder->obj && result == PS_OK && i < builder->source_count; i++)
        result = place_mesh(builder, i, &job->to_scene);
    for (size_t i = 0; !builder->obj && result == PS_OK && i < job->node_count; i++)
        result = place_instances(builder, i);
    for (size_t i = 0; i < builder->source_count; i++)
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
    struct mesh_job *job = builder->job;
    struct scene_description *fragment = job->fragment;
    bool is_obj = job->format == FORMAT_OBJ;
    size_t count = is_obj ? job->obj.part_count : job->scene->mNumMeshes;
    builder->source_count = count;
    builder->obj = is_obj ? obj_filling_create(job) : NULL;
    fragment->meshes = calloc(count + 1, sizeof *fragment->meshes);
    builder->meshes = malloc((count + 1) * sizeof *builder->meshes);
    builder->dropped = calloc(count + 1, sizeof *builder->dropped);
    builder->scratch = malloc((largest_mesh(job) + 1) * sizeof(uint32_t));
    if (!fragment->meshes || !builder->meshes || !builder->dropped || !builder->scratch ||
        (is_obj && !builder->obj))
        return mesh_out_of_memory(job, count * sizeof *fragment->meshes);
    for (size_t i = 0; i < count; i++)
        builder->meshes[i] = NO_INDEX;
    return PS_OK;
}

static void release(struct builder *builder)
{
    obj_filling_destroy(builder->obj);
    free(builder->meshes);
    free(builder->dropped);
    free(builder->scratch);
}

ps_result mesh_read_objects(struct mesh_job *job)
{
    struct builder builder = {.job = job};
    ps_result result = prepare(&builder);
    if (result == PS_OK)
        result = place_all(&builder);
    mesh_note_colors(job);
    if (result == PS_OK && job->fragment->object_count == 0)
        result = error_set(job->error, PS_ERROR_INVALID, "%s: the file has no triangles%s",
                           job->request->path,
                           job->gltf.draco ? ", or this assimp does not unpack Draco" : "");
    release(&builder);
    return result;
}
