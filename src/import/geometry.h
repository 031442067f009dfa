/* geometry.h: the geometry of a mesh file: triangles, normals and colours of assimp's meshes, of
 * OBJ's parts, and of PLY. */
#ifndef IMPORT_GEOMETRY_H
#define IMPORT_GEOMETRY_H

#include "import/job.h"

struct mesh_geometry {
    const struct aiMesh *mesh;
    const struct json *primitive; /* glTF: as the file says; or NULL */
    bool second_uv, colors;
    uint32_t *scratch; /* as many as the mesh has vertices */
};

/* Fills a zeroed mesh with the triangles that have an area and whose corners are finite, and counts
 * the others. */
ps_result mesh_fill(struct mesh_job *job, const struct mesh_geometry *geometry,
                    struct mesh_description *mesh, size_t *dropped);

/* Whether a triangle has an area that floats can tell; not where a corner is not finite. */
bool mesh_has_area(ps_vec3 a, ps_vec3 b, ps_vec3 c);

/* What a mesh has besides positions. */
struct mesh_parts {
    bool normals, uv, second_uv, colors;
};

/* Numbers the vertices that triangles have, of `old_count`, in their order, and renames them in the
 * triangles: how many. A vertex that none has gets UINT32_MAX. */
size_t mesh_number_vertices(struct mesh_description *mesh, uint32_t *numbers, size_t old_count);

/* Room for what `count` vertices have, not filled. */
ps_result mesh_allocate_vertices(struct mesh_job *job, struct mesh_description *mesh, size_t count,
                                 const struct mesh_parts *parts);

/* Of a mesh that has triangles: gives corners without a normal that of their triangle, or a mesh
 * without any those by the angle that was asked for. */
ps_result mesh_settle_normals(struct mesh_job *job, struct mesh_description *mesh);

/* --- vertex_colors.c
 * ---------------------------------------------------------------------------- */

/* Whether its vertices have colours other than white. */
bool mesh_has_colors(struct mesh_job *job, const struct mesh_geometry *geometry);

/* Linear colours, 0..1, with their alpha, of the vertices whose new index is not UINT32_MAX. */
void mesh_fill_colors(struct mesh_job *job, const struct mesh_geometry *geometry,
                      const uint32_t *new_indices, float (*filled)[4]);

/* One colour of sRGB, as mesh_fill_colors makes it. */
void mesh_fill_color(struct mesh_job *job, const float srgb[3], float rgba[4]);

/* Notes what was left out of all of them. */
void mesh_note_colors(struct mesh_job *job);

/* --- obj_mesh.c
 * ---------------------------------------------------------------------------------- */

/* Of the parts of an OBJ file, one after the other. */
struct obj_filling;

/* Released with obj_filling_destroy, which takes NULL. NULL: out of memory. */
struct obj_filling *obj_filling_create(struct mesh_job *job);
void obj_filling_destroy(struct obj_filling *filling);

/* mesh_fill for a part. `colors`: whether it takes those of its vertices. */
ps_result obj_fill(struct obj_filling *filling, const struct obj_part *part, bool colors,
                   struct mesh_description *mesh, size_t *dropped);

/* mesh_has_colors for a part. */
bool obj_has_colors(const struct mesh_job *job, const struct obj_part *part);

/* --- ply_mesh.c
 * ---------------------------------------------------------------------------------- */

/* mesh_fill for a PLY file that is read here; takes its triangles. */
ps_result ply_fill(struct mesh_job *job, bool colors, struct mesh_description *mesh,
                   size_t *dropped);

/* mesh_has_colors for such a file. */
bool ply_has_colors(const struct mesh_job *job);

/* --- smooth_angle.c
 * ------------------------------------------------------------------------------ */

/* Gives a mesh of at least one triangle, without normals, those of smooth surfaces, whose edges are
 * sharp where normals of triangles differ by more than the angle, 0 to 180. Vertices at which
 * smooth surfaces meet are split. */
ps_result mesh_smooth_by_angle(struct mesh_job *job, struct mesh_description *mesh, double degrees);

#endif
