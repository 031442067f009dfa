/* light_join.h: soft shadows with few rays: pixels take in what the pixels around them found.
 *
 * A pixel in a half-shadow has light that its few shadow rays tell badly; those of its neighbours, which
 * go to other points of the same lamp, tell nearly the same. So the direct irradiance of a pixel becomes
 * a mean over 5x5 pixels (pair_mean.h), of those that see the lights alike.
 *
 * A shadow finer than that, inside of a half-shadow, is blurred. That is a bias, and the reason for asking
 * first.
 */
#ifndef PIPELINE_LIGHT_JOIN_H
#define PIPELINE_LIGHT_JOIN_H

#include "film/gbuffer.h"

/* Puts joined direct irradiance in the place of what each lane found by itself; after
 * gbuffer_prepare_join. */
void light_join(struct gbuffer *gbuffer, uint32_t threads);

#endif
