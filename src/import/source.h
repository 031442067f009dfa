/* source.h: reads the file and its companions. */
#ifndef IMPORT_SOURCE_H
#define IMPORT_SOURCE_H

#include "import/job.h"

/* Fills files, gltf and scene. */
ps_result mesh_source_open(struct mesh_job *job);

/* Splits polygons into triangles. */
ps_result mesh_source_triangulate(struct mesh_job *job);

#endif
