/* ply_data.h: the numbers of a binary PLY file. For ply.c. */
#ifndef IMPORT_PLY_DATA_H
#define IMPORT_PLY_DATA_H

#include "import/obj_text.h"
#include "import/ply.h"
#include "import/ply_header.h"

struct workers;

/* Fills the arrays. Polygons are fans, of which `polygons`, to be freed, has each once.
 * PS_ERROR_INVALID or _MEMORY. */
ps_result ply_data_read(const struct mesh_file *file, const struct ply_header *header,
                        struct workers *workers, struct ply *ply, struct obj_polygon **polygons,
                        size_t *polygon_count, struct error *error);

#endif
