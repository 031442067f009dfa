/* mesh_nesting.h: depth and sizes of COLLADA and FBX files, before assimp reads them.
 *
 * Its readers call themselves for what is nested, to any depth, and take room for as many numbers as
 * the file announces; a file of a few kilobytes could use up the stack or the memory.
 */
#ifndef PARSER_MESH_NESTING_H
#define PARSER_MESH_NESTING_H

#include "parser/mesh_files.h"

#define MESH_NESTING 256

/* PS_ERROR_INVALID where elements are nested deeper than MESH_NESTING, or an array announces more
 * numbers than the file has bytes. */
ps_result dae_check(const struct mesh_file *file, struct error *error);

/* The same for FBX, as text or binary; a binary file's records must lie inside each other. */
ps_result fbx_check(const struct mesh_file *file, struct error *error);

#endif
