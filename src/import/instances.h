/* instances.h: EXT_mesh_gpu_instancing: many placements of one node's mesh. */
#ifndef IMPORT_INSTANCES_H
#define IMPORT_INSTANCES_H

#include "import/gltf_data.h"
#include "scene/affine.h"

/* Placements within the node's space, in the arena of `gltf`, each of `meshes`, at least one;
 * not present where no attribute places. `node`: its JSON, or NULL. PS_ERROR_INVALID, _IO or
 * _MEMORY. */
struct mesh_instances {
    bool present;
    struct affine *placements;
    size_t count;
};
ps_result mesh_read_instances(struct gltf *gltf, const struct json *node, size_t meshes,
                              struct mesh_instances *instances, struct error *error);

#endif
