/* short_range_rays.h: short rays from pixels, and the light that what they meet gets straight from
 * the lights. */
#ifndef SHORT_RANGE_SHORT_RANGE_RAYS_H
#define SHORT_RANGE_SHORT_RANGE_RAYS_H

#include "short_range/short_range_light.h"
#include <psplat/host.h>
#include <psplat/tile.h>

/* Those of one pass. */
struct gather_rays {
    const ps_host *host;
    const ps_pass *pass;
    struct gathered_light *near;
    uint64_t first_tile; /* of those that are at work */
};

/* Sets of random numbers. */
enum { GATHER_DIRECTIONS = 1, GATHER_LAMPS, GATHER_PILOT_DIRECTIONS, GATHER_PILOT_LAMPS };

/* Those for directions, and for points on lights. */
struct gather_streams {
    uint32_t directions, lights;
};

/* What one ray of each point, cosine-distributed, finds of the light that splats leave out:
 * radiance[i] comes to point targets[i], for i < what is returned. `indices`: of each point's
 * random numbers; changed. Any thread. */
size_t gather_rays_shoot(const struct gather_rays *rays, const ps_points *points,
                         struct gather_streams numbers, uint64_t *indices, uint32_t *targets,
                         ps_rgb *radiance);

/* Moves a point to another's place among them. */
void gather_rays_move(ps_points *points, size_t from, size_t to);

/* Calls body(user, i, worker) on all threads for each of `tiles` tiles, rays->first_tile + i;
 * PS_CANCELLED when the user stops it. */
ps_result gather_rays_over_tiles(struct gather_rays *rays, uint32_t tiles, ps_body body,
                                 void *user);

#endif
