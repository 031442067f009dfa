/* escape.h: bundles whose own ray meets nothing, but whose disc does.
 *
 * A beam is as wide as its splat. Where its axis passes beside a surface's end, part of its disc still
 * lights that surface; without it, surfaces that end in the air darken along their ends by a band as
 * wide as the splats, as much as beams whose axis just meets them spread past the end.
 *
 * Rays beside the axis find what such a beam meets. Its size follows the nearest of these distances, as
 * if the axis had met something there: a beam that goes by close to its source is as narrow as its
 * neighbours that do meet the surface.
 */
#ifndef SPLAT_ESCAPE_H
#define SPLAT_ESCAPE_H

#include "splat/box.h"
#include <psplat/host.h>

/* Gives those of n full beams that meet nothing (distance INFINITY) a hit on their axis, as far away
 * as the nearest thing beside it, with a normal of 0, as its slope is anything; hits stay as they are where there is none. Any
 * thread. */
void escape_find(const ps_host *host, const struct box_scene *scene,
                 const ps_box_settings *settings, const ps_source *sources, size_t n, ps_hit *hits);

#endif
