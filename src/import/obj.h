/* obj.h: an OBJ file: its geometry, read here, and an outline of it for assimp, which reads its
 * libraries.
 *
 * A part is a run of triangles of one section (`o`, `g`) and one material (`usemtl`).
 */
#ifndef IMPORT_OBJ_H
#define IMPORT_OBJ_H

#include "import/obj_text.h"

struct obj_part {
    size_t first, count; /* triangles */
    size_t material;     /* of obj.materials, or NO_INDEX */
};

/* Triangles of one smoothing group: up to those of the next run. */
struct obj_run {
    size_t first;
    uint32_t group; /* 0: flat */
};

struct obj {
    struct obj_text text; /* polygons are cut so that no triangle lies outside of them */
    struct obj_part *parts;
    size_t part_count;
    struct obj_run *runs;
    size_t run_count;
    struct text_line *materials; /* each name once, in the order of their first parts */
    size_t material_count;
    /* An OBJ text by the file's name: the libraries, a triangle without a material, and one for
     * each material. Owns its bytes alone. */
    struct mesh_file outline;
};

/* Cuts the polygons of the text anew, in place (obj_polygon.c). False: out of memory. */
bool obj_cut_polygons(const struct obj_text *text);

/* PS_ERROR_INVALID (a bad line, no triangle) or PS_ERROR_MEMORY. obj refers to the file; released
 * in any case. */
ps_result obj_open(struct obj *obj, struct mesh_file *file, struct error *error);
void obj_release(struct obj *obj);

#endif
