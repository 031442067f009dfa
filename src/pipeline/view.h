/* view.h: what the camera sees: fills the G-buffer.
 *
 * From each pixel a path runs over mirrors, gloss and glass to the first diffuse surface, where it
 * ends and indirect light is gathered; a surface of several lobes chooses one by chance, anew in each
 * pass, so that passes average over all. On the way the path collects what is emitted, and what gloss
 * reflects of the lights.
 */
#ifndef PIPELINE_VIEW_H
#define PIPELINE_VIEW_H

#include "film/gbuffer.h"

struct view_pass {
    const struct scene *scene;
    const struct trace *trace;
    const struct shadow_maps *maps; /* for what gloss reflects of the lights; NULL: shadow rays */
    struct gbuffer *gbuffer;
    uint64_t seed;
    uint32_t number;          /* of the pass */
    float jitter_x, jitter_y; /* from the pixels' corners to where the pass looks, in pixels */
};

/* Fills tile `index`, and zeroes its accumulators. */
void view_trace_tile(const struct view_pass *pass, uint32_t index);

#endif
