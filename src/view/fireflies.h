/* fireflies.h: single pixels that rays by chance found too much light for.
 *
 * Samples of pixels at edges share the mean of what the pixels around found (edges.h): a firefly among these becomes a square as large
 * as that mean, which no denoiser tells from light. So before that, what a pixel has beyond a multiple of the mean of the
 * others that are alike, and of those nearby among them, is shared out evenly to all. The multiple is smaller where pixels show
 * what they do by chance (gbuffer.h). All within a tile: no light is lost, as clamping loses it, and nothing is seen of it, since they
 * are many. Pixels off the edges show what they found themselves: what these give to those at edges is as much as they would get, in
 * the mean alone.
 */
#ifndef VIEW_FIREFLIES_H
#define VIEW_FIREFLIES_H

#include "film/gbuffer.h"

/* Shares out the indirect light of a tile's fireflies, when all of it is there, and pixels off the edges have been added to the
 * film as they are. Any thread, a tile each. */
void fireflies_spread(struct gbuffer *gbuffer, uint32_t tile);

#endif
