/* cut.h: lights the pixels of a tile by cuts through a tree of virtual lights.
 *
 * Walter et al. 2005. A cut is a set of clusters that holds each light once. It begins at the root.
 * The cluster whose error could be largest, that is, the bound on its light, is replaced by its
 * children, until no error can exceed a share of the light found, or the cut has as many clusters
 * as it may. Light and bounds are luminances. One of the children has the parent's representative,
 * and costs no shadow ray.
 *
 * All pixels of a tile take a step together, so that shadow rays go to the tracer in packets.
 */
#ifndef PSPLAT_ESTIMATOR_CUT_H
#define PSPLAT_ESTIMATOR_CUT_H

#include "light_tree.h"

struct cut_setting {
    const ps_host *host;
    const ps_pass *pass;
    const struct light_tree *tree;
    float clamp;   /* scene units */
    float error;   /* share of the light that no cluster's error may exceed */
    uint32_t most; /* clusters in a cut */
};

/* A cluster of a cut. */
struct cut_entry {
    /* On its light, as a luminance of irradiance; 0: a single light, or none that gets here. */
    float bound;
    uint32_t cluster;
    float transfer; /* irradiance of its representative, a unit of power */
};

/* `room`: PS_TILE_PIXELS * setting->most entries. Sets the irradiance (W/m^2) of each point;
 * returns how many clusters their cuts have together. Any thread. */
uint64_t cut_light_points(const struct cut_setting *setting, const ps_points *points,
                          struct cut_entry *room, ps_rgb *irradiance);

#endif
