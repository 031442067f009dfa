/* fireflies.h: pixels that are far too bright because a rare path met a bright light.
 *
 * Edge pixels interpolate indirect light over 5x5 pixels (edge_interpolation.h): a firefly among
 * these would become a square of 5x5 pixels, which no denoiser recognizes. So before that, with B
 * the sum of the irradiance's channels, what a pixel has beyond
 *
 *     limit = t max(mean of B, mean of B weighted by inverse squared distance)
 *
 * over the other pixels of the tile that see its surface (at least 8) is distributed evenly among
 * them. t is 4, or 2 where the pixel's sample is stochastic (lens, gloss, glass). Clamping would
 * lose the light. Pixels off the edges are in the film already, as they were: so light is conserved
 * on average, not pixel by pixel.
 */
#ifndef VIEW_FIREFLIES_H
#define VIEW_FIREFLIES_H

#include "film/gbuffer.h"

/* Distributes the excess irradiance of a tile's fireflies, when its pixels off the edges have been
 * added to the film. Different tiles may run on different threads. */
void fireflies_spread(struct gbuffer *gbuffer, uint32_t tile);

#endif
