/* ply_header.h: what a PLY file says of its vertices and faces. */
#ifndef IMPORT_PLY_HEADER_H
#define IMPORT_PLY_HEADER_H

#include "import/files.h"

#define PLY_PROPERTIES 32 /* of an element at most */

/* How a number is stored. */
enum ply_type {
    PLY_CHAR,
    PLY_UCHAR,
    PLY_SHORT,
    PLY_USHORT,
    PLY_INT,
    PLY_UINT,
    PLY_FLOAT,
    PLY_DOUBLE,
    PLY_NO_TYPE
};

enum ply_role {
    PLY_X,
    PLY_Y,
    PLY_Z,
    PLY_NX,
    PLY_NY,
    PLY_NZ,
    PLY_U,
    PLY_V,
    PLY_RED,
    PLY_GREEN,
    PLY_BLUE,
    PLY_ALPHA,
    PLY_INDICES, /* the vertices of a face */
    PLY_OTHER
};

struct ply_property {
    enum ply_type type;
    enum ply_type count_type; /* of a list; PLY_NO_TYPE: it is no list */
    enum ply_role role;
    size_t offset; /* in its element, where no list comes before it */
};

struct ply_element {
    uint64_t count;
    struct ply_property properties[PLY_PROPERTIES];
    size_t property_count;
    size_t size; /* bytes, without lists */
};

struct ply_header {
    bool big_endian, is_text;
    struct ply_element vertices, faces;
    size_t data; /* where they start in the file */
};

/* Whether the file has an end of its header; assimp looks for one without end. */
bool ply_header_ends(const struct mesh_file *file);

/* False where the file is not of the kind that ply.h says. */
bool ply_header_read(const struct mesh_file *file, struct ply_header *header);

/* The property of that role; NULL: none. */
const struct ply_property *ply_property_of(const struct ply_element *element, enum ply_role role);

size_t ply_type_size(enum ply_type type);

/* A number that is stored there. */
double ply_number(const char *at, enum ply_type type, bool big_endian);

#endif
