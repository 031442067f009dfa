/* edges.h: smooth edges in a single pass: more camera samples where neighbouring pixels differ.
 *
 * A pass looks at one point of each pixel, so that edges come out as stairs until many passes are added
 * up; yet most pixels lie on one surface, of which one look tells all. Adaptive supersampling (Whitted
 * 1980, "An improved illumination model for shaded display", section 3) looks again only where a pixel
 * differs from a neighbour: in its surface, in its albedo, or in the light that comes from it straight
 * from the lights, if by more than the noise of its shadow rays. Each further sample has surface, emission and
 * direct light of its own. Its indirect light, which is dear, comes from what the pixels around found on the same surface (before that,
 * fireflies.h), so that estimators are not asked again: the mean of these by inverse square distance (gbuffer_nearness()), since light
 * changes fast in corners and under eaves, and what two pixels find by chance may lie far apart. All pixels look at the same
 * places in them. Tracing at a higher resolution would cost everywhere.
 *
 * Pass 0 decides for all, whether it is rendered here or not. If each decided for itself, looks that are rare (at things thinner than a
 * pixel, at what glass mirrors) would be replaced by a mean, and common ones kept: light would go missing,
 * however many the passes. Pixels whose look is a matter of chance count as edges: those seen through a
 * lens, in gloss, or in a surface that mirrors and lets through. A single pass still misses things too thin
 * for the middle of any pixel, but beside an edge.
 *
 * Where no pixel around sees a sample's surface, it asks all of the tile; if none of these does, those around
 * that see its object, or else all that see any.
 */
#ifndef VIEW_EDGES_H
#define VIEW_EDGES_H

#include "direct/direct.h"
#include "film/film.h"

/* A pass whose G-buffer has all its light. */
struct edge_pass {
    const struct lighting *lighting;
    const struct gbuffer *gbuffer;
    const bool *edges; /* which lanes of its tiles are edges, by edges_find in pass 0 */
    uint64_t seed;
    uint32_t number;  /* of the pass */
    uint32_t samples; /* of a pixel at an edge, at most MOST_AA_SAMPLES */
};

/* Which pixels of a tile differ from a neighbour to the left, right, top or bottom, or show what they do by
 * chance. Reads neighbouring tiles. */
void edges_find(const struct gbuffer *gbuffer, uint32_t tile, bool edges[PS_TILE_PIXELS]);

/* Adds a tile's pixels at edges to the film, by the mean of their samples. Any thread, a tile each, when fireflies_spread() is
 * done for all tiles. */
void edges_add_tile(const struct edge_pass *pass, uint32_t tile, struct film *film);

#endif
