/* job.h: one mesh import under way, shared by its steps.
 *
 * The steps are mesh_source (files and assimp), mesh_check (is what assimp returned sound?),
 * mesh_material, mesh_object (geometry), mesh_light and mesh_camera.
 */
#ifndef IMPORT_JOB_H
#define IMPORT_JOB_H

#include "import/format.h"
#include "import/gltf.h"
#include <assimp/scene.h>

#define MESH_TRIANGLES ((size_t)200 * 1000 * 1000) /* and vertices */

/* A node of assimp's tree, with its way to the root of the file. */
struct mesh_node {
    const struct aiNode *node;
    struct affine to_file;
};

struct mesh_job {
    const struct mesh_request *request;
    struct scene_description *fragment;
    struct mesh_report *report;
    struct error *error;
    enum mesh_format format;
    struct mesh_files files;
    struct mesh_file *main_file;
    bool main_is_open;         /* by assimp, which reads it */
    struct mesh_file *library; /* OBJ: the last MTL file read, or NULL */
    struct gltf gltf;
    const struct aiScene *scene;
    struct mesh_node *nodes; /* each before its children */
    size_t node_count;
    struct affine to_scene; /* what the request says, from the file's space */
    double scale;           /* the factor of to_scene on lengths (the mean one) */
    size_t *materials;      /* in the fragment, for each of assimp's; or NO_INDEX */
};

/* Adds a sentence to the report's notes, as far as there is room. */
void mesh_note(struct mesh_job *job, const char *format, ...) PRINTF_LIKE(2, 3);

ps_result mesh_out_of_memory(struct mesh_job *job, size_t bytes);

/* source.c: reads the file and its companions; fills files, gltf and scene. */
ps_result mesh_source_open(struct mesh_job *job);
/* Splits polygons into triangles. */
ps_result mesh_source_triangulate(struct mesh_job *job);

/* check.c: PS_ERROR_INVALID where indices, counts or pointers of assimp's scene are wrong;
 * fills nodes. */
ps_result mesh_check_scene(struct mesh_job *job);

/* object.c: meshes and objects. */
ps_result mesh_read_objects(struct mesh_job *job);

/* geometry.c: fills a zeroed mesh with the triangles of one of assimp's that have an area and
 * whose corners are finite, and counts the others. */
struct mesh_geometry {
    const struct aiMesh *mesh;
    const ps_vec3 *smooth; /* normals in place of the mesh's, or NULL */
    uint32_t *scratch;     /* as many as the mesh has vertices */
};
ps_result mesh_fill(struct mesh_job *job, const struct mesh_geometry *geometry,
                    struct mesh_description *mesh, size_t *dropped);

/* smooth.c: normals by the smoothing groups of an OBJ file, one array for each of assimp's
 * meshes, NULL where the mesh has its own or is flat; NULL as a whole where there are none. */
ps_result mesh_smooth_normals(struct mesh_job *job, ps_vec3 ***normals);
void mesh_smooth_release(const struct mesh_job *job, ps_vec3 **normals);

/* material.c: materials and textures; fills job->materials. */
ps_result mesh_read_materials(struct mesh_job *job);

/* camera.c, light.c */
ps_result mesh_read_cameras(struct mesh_job *job);
ps_result mesh_read_lights(struct mesh_job *job);

/* From the node's space into the scene. */
struct affine mesh_node_placement(const struct mesh_job *job, const struct mesh_node *node);

/* The node whose name a camera or light of assimp's bears: the n-th such node for the n-th bearer;
 * NULL where there is none. */
const struct mesh_node *mesh_node_named(const struct mesh_job *job, const char *name, size_t n);

/* The JSON of a node of the list above; NULL for one that assimp made. */
const struct json *mesh_gltf_node(const struct mesh_job *job, size_t index);

static inline ps_vec3 mesh_vector(struct aiVector3D v)
{
    return (ps_vec3){v.x, v.y, v.z};
}

static inline bool mesh_is_finite(ps_vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

#endif
