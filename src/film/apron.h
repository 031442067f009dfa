/* apron.h: a tile and the pixels around it, row by row, for means over neighbours.
 *
 * Plain arrays in which a neighbour is an offset away, so that compilers make vectors of the loops
 * over a row; each loop has to write to an array of its own for that. Where all is flat, no
 * neighbours need to be looked at, and sums over windows are made of sums over columns.
 */
#ifndef FILM_APRON_H
#define FILM_APRON_H

#include "film/gbuffer.h"
#include <psplat/host.h>

#define APRON_MARGIN (PS_MOST_INTERLEAVE / 2) /* pixels to each side */
#define APRON_SIDE (PS_TILE_SIZE + 2 * APRON_MARGIN)

/* What pixels see; pixel (0, 0) of the tile is at [APRON_MARGIN][APRON_MARGIN]. Where there is
 * none, the normal is 0. */
struct apron_surfaces {
    float position_x[APRON_SIDE][APRON_SIDE], position_y[APRON_SIDE][APRON_SIDE],
        position_z[APRON_SIDE][APRON_SIDE];
    float normal_x[APRON_SIDE][APRON_SIDE], normal_y[APRON_SIDE][APRON_SIDE],
        normal_z[APRON_SIDE][APRON_SIDE];
};

/* Which pixels of a row of the tile lie on the surface of their neighbours at (dx, dy), with
 * normals no farther apart than `least_cosine` (0: any on one surface): 1 or 0. */
static inline void apron_find_same(const struct apron_surfaces *at, int row, int dx, int dy,
                                   float least_cosine, int same[PS_TILE_SIZE])
{
    int here_row = APRON_MARGIN + row, there_row = here_row + dy;
    for (int i = 0; i < PS_TILE_SIZE; i++) {
        int here = APRON_MARGIN + i, there = here + dx;
        ps_vec3 normal = {at->normal_x[here_row][here], at->normal_y[here_row][here],
                          at->normal_z[here_row][here]};
        ps_vec3 other_normal = {at->normal_x[there_row][there], at->normal_y[there_row][there],
                                at->normal_z[there_row][there]};
        ps_vec3 way = {at->position_x[there_row][there] - at->position_x[here_row][here],
                       at->position_y[there_row][there] - at->position_y[here_row][here],
                       at->position_z[there_row][there] - at->position_z[here_row][here]};
        same[i] = (ps_dot(normal, other_normal) > least_cosine) &
                  gbuffer_same_surface(normal, other_normal, way);
    }
}

/* Whether all pixels of the tile and up to `radius` around it lie on one plane, with one normal:
 * then any two are on the same surface, and means are plain sums. Most tiles of most pictures. */
bool apron_is_flat(const struct apron_surfaces *at, int radius);

/* Sums over the window of each pixel of the tile, up to `radius` to each side; the border of the
 * window counts `border` times. */
void apron_sum(const float from[APRON_SIDE][APRON_SIDE], int radius, float border,
               float to[PS_TILE_SIZE][PS_TILE_SIZE]);

#endif
