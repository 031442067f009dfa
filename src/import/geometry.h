/* geometry.h: triangles and normals of one of assimp's meshes. */
#ifndef IMPORT_GEOMETRY_H
#define IMPORT_GEOMETRY_H

#include "import/job.h"

struct mesh_geometry {
    const struct aiMesh *mesh;
    bool second_uv, colors;
    const ps_vec3 *smooth; /* normals in place of the mesh's, or NULL */
    uint32_t *scratch;     /* as many as the mesh has vertices */
};

/* Whether its vertices have colours other than white. */
bool mesh_has_colors(const struct aiMesh *source);

/* Fills a zeroed mesh with the triangles that have an area and whose corners are finite, and counts the
 * others. */
ps_result mesh_fill(struct mesh_job *job, const struct mesh_geometry *geometry,
                    struct mesh_description *mesh, size_t *dropped);

/* Normals by the smoothing groups of an OBJ file (smooth.c), one array for each of assimp's meshes, NULL
 * where the mesh has its own or is flat; NULL as a whole where there are none. */
ps_result mesh_smooth_normals(struct mesh_job *job, ps_vec3 ***normals);
void mesh_smooth_release(const struct mesh_job *job, ps_vec3 **normals);

#endif
