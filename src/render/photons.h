/* photons.h: the stream of a pass's photons: injected, stratified, in the order of emission.
 *
 * Paths go through in batches, so memory does not grow with their number, unless the stratification
 * wants to see all photons of a pass at once.
 */
#ifndef RENDER_PHOTONS_H
#define RENDER_PHOTONS_H

#include "base/error.h"
#include <psplat/strategy.h>
#include <stdbool.h>

struct render;

#define PHOTON_CHUNKS 16 /* of PS_PATH_CHUNK paths, that are injected at a time */

struct photon_list {
    ps_photon *items; /* owned */
    size_t count, capacity;
};

struct photon_stream {
    struct render *render;      /* that it serves */
    struct photon_list *chunks; /* one for each chunk of a batch of paths; owned */
    struct photon_list batch;   /* what was handed out last */
    uint64_t next_path, path_count;
    /* How far apart light lands that comes straight from the lights, where the picture may see it
     * (importance.h), by the pass's first paths: the root mean square distance from its middle,
     * weighed by flux, in scene units; 0 where none lands. And the part of the paths that lands
     * there. */
    float spread;
    double near_share;
    /* Where its first paths land that met mirrors, glass and gloss alone: caustic_count of them,
     * owned; and how many such photons the pass has for each. */
    ps_vec3 *caustics;
    size_t caustic_count;
    double photons_per_caustic;
    bool prepared; /* the injection, for this pass */
    bool filled;   /* the chunks, with the next paths' photons */
};

ps_result photon_stream_create(struct render *render, struct photon_stream *stream,
                               struct error *error);
void photon_stream_release(struct photon_stream *stream);

/* Starts over, with the pass that the render now describes. */
void photon_stream_rewind(struct photon_stream *stream);

/* Makes the injection ready for the pass and injects its first paths, which tells path_count,
 * spread and caustics; does so once a pass. */
ps_result photon_stream_prepare(struct photon_stream *stream, struct error *error);

/* The next photons; 0 of them after the last. Valid until the next call. */
ps_result photon_stream_next(struct photon_stream *stream, const ps_photon **photons, size_t *n,
                             struct error *error);

/* All photons of the pass as they are injected, before stratification; uses up the stream. Valid
 * until it is rewound. */
ps_result photon_stream_injected(struct photon_stream *stream, ps_photon **photons, size_t *n,
                                 struct error *error);

/* Share of the pass's paths that were injected, 0..1. */
double photon_stream_progress(const struct photon_stream *stream);

#endif
