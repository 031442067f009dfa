/* rays.h: the final gather of a group of points: the pixels of a tile, or surfels.
 *
 * Paths leave the points (../paths.h) and go on until a cache of irradiance knows the rest, or to their end. Their first
 * directions are drawn where those before them found light (guide.h).
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_RAYS_H
#define PSPLAT_ESTIMATOR_GATHER_RAYS_H

#include "guide.h"
#include "surfels.h"

#include "../paths.h"
#include <stdbool.h>

/* Guides of a group, one for each way that its surfaces face. */
enum { GATHER_GUIDES = 4 };

struct gather_setting {
    struct paths_setting paths;
    uint64_t samples;            /* from each point */
    const struct surfels *cache; /* NULL: none */
    bool no_caustics;            /* on the points: somebody else adds them */
};

struct gather {
    const struct gather_setting *setting;
    uint64_t index; /* of the group, among all that draw random numbers: a tile's own */
    ps_points points;
    ps_rgb irradiance[PS_TILE_PIXELS]; /* W/m^2, of each point: the result */
    ps_rgb half[PS_TILE_PIXELS];       /* the same by the first half of each round's samples */
    /* Of the sample under way: its index, what it found, its first direction, and random numbers for lookups. */
    uint64_t samples[PS_TILE_PIXELS];
    ps_rgb found[PS_TILE_PIXELS];
    ps_vec3 directions[PS_TILE_PIXELS];
    float places[PS_TILE_PIXELS][2];
    uint8_t guide_of[PS_TILE_PIXELS];
    uint32_t guide_count;
    struct guide guides[GATHER_GUIDES];
};

/* Fills in `irradiance` and `half`; setting, index and points are given, the rest is 0. Any thread. */
void gather_points(struct gather *gather);

#endif
