/* photon_pilot.h: what the first paths of a pass tell of where light lands, by which radii are
 * chosen. */
#ifndef RENDER_PHOTON_PILOT_H
#define RENDER_PHOTON_PILOT_H

struct photon_stream;

/* By the photons in the stream's chunks: how wide light spreads, which part of it the picture may
 * see, and where caustics lie. A function of the pass alone. */
void photon_pilot_find(struct photon_stream *stream);

#endif
