/* discontinuity_buffer.h: soft shadows with few rays: pixels take in what the pixels around them
 * found.
 *
 * A pixel in a half-shadow has light that its few shadow rays tell badly; those of its neighbours,
 * which go to other points of the same light, tell nearly the same. So the direct irradiance of a
 * pixel becomes a mean over 5x5 pixels (geometry_filter.h), of those that see the lights alike.
 *
 * The pixels of any 5x5 share one run of numbers, of which each place in such a window has a part:
 * together they look at the light as evenly as one pixel with 25 times as many rays. Under a light
 * they have as much noise with 4 rays as with 8 where each draws numbers of its own. Since all
 * windows have the same run, noise turns into the shadows of that many small lights, which is seen
 * where few of their rays find any light (a sky through windows): less than noise was, until passes
 * add up.
 *
 * A shadow finer than that, inside of a half-shadow, is blurred. That is a bias, and the reason for
 * asking first.
 */
#ifndef DIRECT_DISCONTINUITY_BUFFER_H
#define DIRECT_DISCONTINUITY_BUFFER_H

#include "base/parallel.h"
#include "direct/direct.h"

/* The runs of a tile's lanes, of `samples` numbers for each pass. */
void discontinuity_buffer_runs(const struct gbuffer *gbuffer, uint32_t tile, uint32_t pass,
                               uint32_t samples, struct light_runs *runs);

/* Puts joined direct irradiance in the place of what each lane found by itself; after
 * gbuffer_prepare_discontinuity_buffer. */
void discontinuity_buffer(struct gbuffer *gbuffer, struct workers *workers);

#endif
