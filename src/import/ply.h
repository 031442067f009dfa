/* ply.h: the geometry of a PLY file (Turk 1994, "The PLY polygon file format"), read here, and an
 * outline for assimp, which reads what comments say of textures.
 *
 * Of files whose elements are `vertex` and `face` alone, as scanners and sculpting programs write
 * them. Others are left to assimp as a whole: it keeps some 250 bytes a triangle, and reads 35 MB a
 * second by one thread.
 */
#ifndef IMPORT_PLY_H
#define IMPORT_PLY_H

#include "import/files.h"

struct ply {
    bool is_read; /* else all is empty, and assimp reads the file */
    ps_vec3 *vertices;
    ps_vec3 *normals; /* NULL: none; and so on: */
    float (*uv)[2];
    float (*colors)[4];       /* as the file has them: sRGB, and alpha */
    uint32_t (*triangles)[3]; /* polygons are cut */
    size_t vertex_count, triangle_count;
    /* A text by the file's name: its comments, and one triangle; owns its bytes alone. */
    struct mesh_file outline;
};

/* PS_ERROR_INVALID (the file ends too soon, a vertex that is not there) or _MEMORY; released in any
 * case. */
ps_result ply_open(struct ply *ply, const struct mesh_file *file, struct error *error);
void ply_release(struct ply *ply);

#endif
