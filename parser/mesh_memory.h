/* mesh_memory.h: mesh import from memory, for tests and fuzzers. */
#ifndef PARSER_MESH_MEMORY_H
#define PARSER_MESH_MEMORY_H

#include "parser/mesh_import.h"

struct mesh_memory_file {
    const char *path; /* as the request, or the mesh file, would name it */
    const void *bytes;
    size_t length;
};

/* mesh_import where these files, and no others, exist; the disk is not looked at. */
ps_result mesh_import_memory(const struct mesh_request *request,
                             const struct mesh_memory_file *files, size_t file_count,
                             struct scene_description *fragment, struct mesh_report *report,
                             struct error *error);

#endif
