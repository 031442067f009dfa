/* geometry.h: triangles and normals of one of assimp's meshes. */
#ifndef IMPORT_GEOMETRY_H
#define IMPORT_GEOMETRY_H

#include "import/job.h"

struct mesh_geometry {
    const struct aiMesh *mesh;
    const struct json *primitive; /* glTF: as the file says; or NULL */
    bool second_uv, colors;
    const ps_vec3 *smooth; /* normals in place of the mesh's, or NULL */
    uint32_t *scratch;     /* as many as the mesh has vertices */
};

/* Fills a zeroed mesh with the triangles that have an area and whose corners are finite, and counts the
 * others. */
ps_result mesh_fill(struct mesh_job *job, const struct mesh_geometry *geometry,
                    struct mesh_description *mesh, size_t *dropped);

/* --- vertex_colors.c ---------------------------------------------------------------------------- */

/* Once, before those below: whether the file's colours can be assigned to its vertices. */
void mesh_check_colors(struct mesh_job *job);

/* Whether its vertices have colours other than white. */
bool mesh_has_colors(struct mesh_job *job, const struct mesh_geometry *geometry);

/* Linear colours, 0..1, with their alpha, of the vertices whose new index is not UINT32_MAX. */
void mesh_fill_colors(struct mesh_job *job, const struct mesh_geometry *geometry,
                      const uint32_t *new_indices, float (*filled)[4]);

/* Notes what was left out of all of them. */
void mesh_note_colors(struct mesh_job *job);

/* --- smooth.c ------------------------------------------------------------------------------------ */

/* Normals by the smoothing groups of an OBJ file, one array for each of assimp's meshes, NULL
 * where the mesh has its own or is flat; NULL as a whole where there are none. */
ps_result mesh_smooth_normals(struct mesh_job *job, ps_vec3 ***normals);
void mesh_smooth_release(const struct mesh_job *job, ps_vec3 **normals);

/* --- smooth_angle.c ------------------------------------------------------------------------------ */

/* Gives a mesh of at least one triangle, without normals, those of smooth surfaces, whose edges are sharp where normals of
 * triangles differ by more than the angle, 0 to 180. Vertices at which smooth surfaces meet are split. */
ps_result mesh_smooth_by_angle(struct mesh_job *job, struct mesh_description *mesh, double degrees);

#endif
