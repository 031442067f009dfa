/* light_join.h: soft shadows with few rays: pixels take in what the pixels around them found.
 *
 * A pixel in a half-shadow has light that its few shadow rays tell badly; those of its neighbours, which
 * go to other points of the same lamp, tell nearly the same (interleaved sampling: Keller and Heidrich
 * 2001, section 4). So the direct irradiance of a pixel becomes a mean over 5x5 pixels. Of these count
 *
 * - those on the same surface, all but flat: bumps keep their shading;
 * - those that see the lights alike (gbuffer_met_alike): nothing crosses the edge of a hard shadow;
 * - pairs that lie opposite each other, both or none. A mean over pairs keeps what falls off evenly, where
 *   one over part of a window would flatten narrow half-shadows and the rims of surfaces.
 *
 * What bends within 5 pixels is blurred: so is a shadow finer than that, inside of a half-shadow. That is a
 * bias, and the reason for asking first.
 */
#ifndef PIPELINE_LIGHT_JOIN_H
#define PIPELINE_LIGHT_JOIN_H

#include "film/gbuffer.h"

/* Puts joined direct irradiance in the place of what each lane found by itself; after
 * gbuffer_prepare_join. */
void light_join(struct gbuffer *gbuffer, uint32_t threads);

#endif
