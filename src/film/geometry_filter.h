/* geometry_filter.h: the mean over a square window, restricted to the same surface (a joint box
 * filter; interleaved sampling, Keller and Heidrich 2001, section 4).
 *
 * Few rays tell a pixel's light badly; its neighbours find nearly the same light. The mean takes
 *
 * - pixels on the same surface, all but flat: bumps keep their shading;
 * - those that see the lights alike (gbuffer_occlusion_alike), where `occlusion` is given: nothing
 *   crosses the edge of a hard shadow;
 * - pairs that lie opposite each other, both or none. A mean over pairs keeps what falls off
 *   linearly, where one over part of a window would flatten what lies along the rims of surfaces.
 *
 * Light that does not vary linearly within the window is blurred (bias).
 */
#ifndef FILM_GEOMETRY_FILTER_H
#define FILM_GEOMETRY_FILTER_H

#include "base/parallel.h"
#include "film/gbuffer.h"

/* Arrays have a value for each lane of each tile; borrowed. */
struct geometry_filter {
    const struct gbuffer *gbuffer;
    const uint64_t *occlusion; /* see gbuffer_occlusion_alike; NULL: does not matter */
    int radius;                /* pixels to each side, at most APRON_MARGIN (apron.h) */
    const ps_rgb *from;
    ps_rgb *to;      /* both NULL: pixels are only counted */
    uint8_t *counts; /* over how many pixels, itself included; NULL: does not matter */
};

/* The most pixels that a mean is taken over. */
static inline int geometry_filter_window(int radius)
{
    return (2 * radius + 1) * (2 * radius + 1);
}

/* Writes to `to` the mean of `from` over each lane's window, and to `counts` the number of pixels
 * in it. Arrays must not overlap. Runs on all workers. */
void geometry_filter_apply(struct geometry_filter *mean, struct workers *workers);

#endif
