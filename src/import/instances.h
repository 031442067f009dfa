/* instances.h: EXT_mesh_gpu_instancing: many placements of one node's mesh. */
#ifndef IMPORT_INSTANCES_H
#define IMPORT_INSTANCES_H

#include "import/gltf_data.h"
#include "scene/affine.h"

/* Placements within the node's space, in the arena of `gltf`; none where it has no instances, or none that count.
 * `node`: its JSON, or NULL. PS_ERROR_INVALID, _IO or _MEMORY. */
struct mesh_instances {
    bool present;
    struct affine *placements;
    size_t count;
};
ps_result mesh_read_instances(struct gltf *gltf, const struct json *node,
                              struct mesh_instances *instances, struct error *error);

#endif
