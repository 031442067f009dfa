/* light_tree.h: virtual lights in a binary tree of clusters, each with a light that represents it.
 *
 * Walter et al. 2005, "Lightcuts: a scalable approach to illumination". A cluster shines as its
 * representative does, with the power of all its lights. The representative is drawn in proportion
 * to power (luminance), and is that of one of the two children, so the mean luminance over draws is
 * that of all lights; colours that differ within a cluster are averaged. The paper merges clusters
 * pair by pair, those that are close and face alike first; here they are split at the median of the
 * widest of six dimensions, three of position and three of direction, which takes n log(n) steps.
 */
#ifndef PSPLAT_ESTIMATOR_LIGHT_TREE_H
#define PSPLAT_ESTIMATOR_LIGHT_TREE_H

#include "../shared/virtual_lights.h"
#include <stdint.h>

struct light_cluster {
    ps_vec3 low, high;       /* box around its lights */
    ps_vec3 axis;            /* of a cone around their normals */
    float cosine;            /* of the cone's half angle */
    ps_rgb power;            /* W: of all its lights */
    uint32_t representative; /* a light */
    uint32_t right; /* second child, the first is the next in the array; 0: a single light */
};

struct light_tree {
    const ps_host *host;
    const struct virtual_lights *lights; /* borrowed */
    struct light_cluster *clusters;      /* 2 * lights - 1, the root first; owned */
};

/* At least one light. Release the tree whatever it returns. */
ps_result light_tree_build(const ps_host *host, const ps_pass *pass,
                           const struct virtual_lights *lights, struct light_tree *tree);
void light_tree_release(struct light_tree *tree);

/* What G (virtual_lights.h) of any of the cluster's lights is at most at a point. Any thread. */
float light_cluster_bound(const struct light_cluster *cluster, ps_vec3 point, ps_vec3 normal,
                          float clamp);

#endif
