/* edges.h: adaptive anti-aliasing in one pass (Whitted 1980, "An improved illumination model for
 * shaded display", section 3).
 *
 * A pass takes one camera sample of each pixel. A pixel is an edge where it differs from one of its
 * four neighbours in surface, in reflectance (by more than a quarter), or in emitted and direct
 * light (by more than a quarter and by more than three standard deviations of its noise), or where
 * its sample is stochastic (lens, gloss, glass). Edge pixels take `samples` camera samples instead,
 * and GLASS_SAMPLES times as many where they or a pixel beside them see glass: light comes through
 * it on several ways, and what is seen changes fast along its rim. Each sample has its own surface,
 * emission and direct light; its indirect light, which is expensive, is interpolated from the
 * pixels around (edge_interpolation.h) after fireflies.h. The offsets of the samples in their pixel
 * are the same in all pixels of one kind, of a pass.
 *
 * Pass 0 chooses the edge pixels of all passes, whether it is rendered here or not. If each pass
 * chose its own, a rare sample (a thin wire, a reflection in glass) would mark its pixel and be
 * replaced by a mean, while common samples stayed: light would be lost, however many the passes
 * (the bias of adaptive sampling: Kirk and Arvo 1991, "Unbiased sampling techniques for image
 * synthesis"). Supersampling all pixels would cost as much everywhere.
 *
 * Things too thin for the middle of any pixel are missed, except beside an edge.
 */
#ifndef VIEW_EDGES_H
#define VIEW_EDGES_H

#include "direct/direct.h"
#include "film/film.h"

/* What a pixel is to a pass. */
enum edge_kind { NO_EDGE, EDGE, GLASS_EDGE };

enum { GLASS_SAMPLES = 4 }; /* of a GLASS_EDGE, for each of an EDGE */

/* A pass whose G-buffer has all its light. */
struct edge_pass {
    const struct lighting *lighting;
    const struct gbuffer *gbuffer;
    const uint8_t *edges; /* enum edge_kind of each lane of its tiles, by edges_find in pass 0 */
    uint64_t seed;
    uint32_t number;  /* of the pass */
    uint32_t samples; /* of a pixel at an edge, at most MOST_AA_SAMPLES */
};

/* The enum edge_kind of each pixel of a tile. Reads neighbouring tiles. */
void edges_find(const struct gbuffer *gbuffer, uint32_t tile, uint8_t edges[PS_TILE_PIXELS]);

/* Adds a tile's pixels at edges to the film, by the mean of their samples. Any thread, a tile each,
 * when fireflies_spread() is done for all tiles. */
void edges_add_tile(const struct edge_pass *pass, uint32_t tile, struct film *film);

#endif
