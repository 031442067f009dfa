/* probe.h: rays through a model, of which a few tell enough that a tree of its triangles would not
 * pay. */
#ifndef MODEL_PROBE_H
#define MODEL_PROBE_H

#include "scene/description.h"

/* Zeroed but for the ray: `direction` is of length 1. */
struct probe {
    ps_vec3 origin, direction;
    float nearest, farthest;            /* distances of what it meets; INFINITY and 0: nothing */
    bool nearest_faces, farthest_faces; /* whether they turn their front to the origin */
};

#define PROBES_AT_MOST 256

/* Sends them through the triangles of all objects that are meshes. */
void probe_all(const struct scene_description *fragment, struct probe *probes, size_t count);

#endif
