/* obj_text.h: the geometry of an OBJ text as it stands there: places, corners of triangles, and
 * statements between them.
 *
 * The text is cut into pieces at ends of lines. One walk counts what each piece has, so that the
 * second knows where in the arrays it belongs; both walks go over the pieces in parallel, and the
 * result does not depend on the threads.
 */
#ifndef IMPORT_OBJ_TEXT_H
#define IMPORT_OBJ_TEXT_H

#include "import/files.h"
#include "import/text.h"

#define OBJ_PIECE ((size_t)1 << 20) /* bytes, and up to the end of a line */
#define OBJ_NONE UINT32_MAX         /* in place of an index: a corner does not have it */

enum obj_statement_kind { OBJ_SECTION, OBJ_MATERIAL, OBJ_LIBRARY, OBJ_SMOOTHING };

/* What holds from some triangle on. */
struct obj_statement {
    enum obj_statement_kind kind; /* OBJ_SECTION: of `o` or `g` */
    struct text_line words;       /* behind the keyword, in the text */
    size_t triangle;              /* the next one */
};

/* A face of more than three corners: corners - 2 triangles that have its first corner in common. */
struct obj_polygon {
    uint32_t triangle, corners;
};

/* Indices count from 0 and are those of things that there are, or OBJ_NONE. */
struct obj_text {
    ps_vec3 *places;    /* `v` */
    float (*colors)[3]; /* of each place, as the file has them; NULL: not even the first has one */
    float (*uv)[2];     /* `vt` */
    ps_vec3 *normals;   /* `vn` */
    size_t place_count, uv_count, normal_count;
    uint32_t (*triangles)[3];        /* places of their corners */
    uint32_t (*triangle_uv)[3];      /* NULL: the text has no `vt` */
    uint32_t (*triangle_normals)[3]; /* NULL: no `vn` */
    size_t triangle_count;
    struct obj_polygon *polygons;
    size_t polygon_count;
    struct obj_statement *statements; /* in their order */
    size_t statement_count;
    bool partly_colored; /* some places have colours and others none */
};

struct workers;

/* Lines that end in a backslash are joined in the file's bytes. Words that are not known are passed
 * over, and so are lines and points. PS_ERROR_INVALID with the number of the line, or
 * PS_ERROR_MEMORY; released in any case. */
ps_result obj_text_read(struct mesh_file *file, struct workers *workers, struct obj_text *text,
                        struct error *error);
void obj_text_release(struct obj_text *text);

#endif
