/* format.h: which mesh files are read, and what is looked at before assimp gets them.
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

/* --- what is looked at before assimp gets a file ----------------------------------------------------
 *
 * Its readers of COLLADA and FBX call themselves for what is nested, to any depth, and take room for as
 * many numbers as the file announces; a file of a few kilobytes could use up the stack or the memory.
 */

#define MESH_NESTING 256

/* PS_ERROR_INVALID where elements are nested deeper than MESH_NESTING, or an array announces more
 * numbers than the file has bytes. */
ps_result dae_check(const struct mesh_file *file, struct error *error);

/* The same for FBX, as text or binary; a binary file's records must lie inside each other. */
ps_result fbx_check(const struct mesh_file *file, struct error *error);

/* assimp takes a PLY header at its word, and waits for ever where its end is missing: here every line
 * of it must be one of the format's, its counts possible in a file of this length, and no element may
 * come twice. */
ps_result ply_check_header(const struct mesh_file *file, struct error *error);

#endif
