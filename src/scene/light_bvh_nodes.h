/* light_bvh_nodes.h: what a light BVH is made of. Only for light_bvh.c and light_bvh_build.c. */
#ifndef SCENE_LIGHT_BVH_NODES_H
#define SCENE_LIGHT_BVH_NODES_H

#include "scene/light_bvh.h"

#define LIGHT_BVH_RUN 4 /* triangles that are one child, at most; among them area decides */

#define NO_NODE UINT32_MAX
#define NO_LIGHT_ABOVE UINT32_MAX

enum child_kind { CHILD_NONE, CHILD_NODE, CHILD_LIGHT, CHILD_TRIANGLES };

struct child {
    uint32_t index; /* of a node, a light, or where its triangles begin in `triangles` */
    uint8_t kind, run;
};

struct node {
    struct light_lanes bounds; /* of the children */
    float most[LIGHT_LANES];   /* lights and triangles of split lights that are in them */
    struct child children[LIGHT_LANES];
    uint32_t parent; /* NO_NODE at the root */
    uint8_t lane;    /* which child of its parent it is */
    uint32_t light;  /* whose triangles are below; or NO_LIGHT_ABOVE */
};

/* Where a light is: a child of a node; a split light's node is that child. */
struct leaf {
    uint32_t node; /* NO_NODE: it is not in the tree */
    uint32_t lane;
};

struct light_bvh {
    const struct light *lights;
    size_t light_count, placed;
    struct node *nodes;
    size_t node_count, node_room;
    struct leaf *leaves;
    uint32_t *triangles;
    size_t triangle_count;
};

#endif
