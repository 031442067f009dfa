/* check.h: what assimp returned, before anything is made of it. */
#ifndef IMPORT_CHECK_H
#define IMPORT_CHECK_H

#include "import/job.h"

/* PS_ERROR_INVALID where faces have vertices that there are not, or there are too many. Whether
 * some faces have more than three corners. */
ps_result mesh_check_faces(struct mesh_job *job, bool *has_polygons);

/* Fills nodes, each before its children. PS_ERROR_INVALID where they are not those of a glTF's
 * JSON. */
ps_result mesh_list_nodes(struct mesh_job *job);

#endif
