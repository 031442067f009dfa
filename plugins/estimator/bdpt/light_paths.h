/* light_paths.h: paths from the lights, one for each pixel of a tile: their vertices, and light
 * tracing.
 *
 * A light path starts as those of photons do. The densities of its first vertex y come from the
 * light: with D that by which next-event estimation at y draws the light's point, and R the density
 * of the light path there over D (ps_light_density), dVCM = 1 / (R cos)^2 and dVC = 1 / (R D
 * cos)^2.
 *
 * From its second vertex on a light path is connected to the camera (Dutre, Lafortune and Willems
 * 1993): what is lit there becomes radiance of the pixel that sees it. The first vertex is lit
 * directly. Such splats go anywhere in the picture; they are kept in lists, which are added up in
 * the order of the paths.
 */
#ifndef PSPLAT_ESTIMATOR_LIGHT_PATHS_H
#define PSPLAT_ESTIMATOR_LIGHT_PATHS_H

#include "subpath.h"

/* Radiance that light tracing brings to a pixel. */
struct splat {
    uint32_t tile, lane;
    ps_rgb radiance;
};

struct splat_list {
    struct splat *items; /* owned */
    size_t count, room;
};

#define NO_VERTEX UINT32_MAX

/* The vertices of one sample's light paths. */
struct light_vertices {
    struct vertex *items; /* owned */
    uint32_t *next;       /* owned: of the same path, NO_VERTEX after the last */
    size_t count, room;
    uint32_t first[PS_TILE_PIXELS]; /* of each lane's path */
};

/* Follows a light path for each of the tile's pixels. Adds splats, times `scale`. False when out of
 * memory. */
int light_paths_trace(const struct bdpt *bdpt, uint32_t tile, const uint64_t *samples, float scale,
                      struct light_vertices *vertices, struct splat_list *splats);

void light_vertices_release(const ps_host *host, struct light_vertices *vertices);
void splat_list_release(const ps_host *host, struct splat_list *splats);

#endif
