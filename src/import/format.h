/* format.h: which mesh files are read.
 *
 * assimp knows forty formats; only these are let through. Each extension leads to one reader of
 * assimp, and never to its guessing by content, which would try them all.
 */
#ifndef IMPORT_FORMAT_H
#define IMPORT_FORMAT_H

#include "import/files.h"

enum mesh_format {
    FORMAT_OBJ,
    FORMAT_GLTF,
    FORMAT_GLB,
    FORMAT_PLY,
    FORMAT_STL,
    FORMAT_COLLADA,
    FORMAT_FBX,
    FORMAT_3DS
};

/* From the extension; PS_ERROR_INVALID, with all that are allowed, for any other. */
ps_result mesh_format_of(const char *path, enum mesh_format *format, struct error *error);

#endif
