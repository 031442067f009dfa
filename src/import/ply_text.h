/* ply_text.h: data of a PLY file that are text, an element a line, as a binary file of the same
 * header has them. */
#ifndef IMPORT_PLY_TEXT_H
#define IMPORT_PLY_TEXT_H

#include "import/files.h"
#include "import/ply_header.h"

struct workers;

/* Makes `packed`, whose bytes are freed by the caller in any case: data alone, little-endian; as
 * many elements as there are lines for. PS_ERROR_INVALID, with the line, where a number is missing;
 * or _MEMORY. */
ps_result ply_text_pack(const struct mesh_file *file, const struct ply_header *header,
                        struct workers *workers, struct mesh_file *packed, struct error *error);

#endif
