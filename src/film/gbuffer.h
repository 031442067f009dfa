/* gbuffer.h: what each pixel of one pass sees, and what the pass has gathered there.
 *
 * Tiles of 16x16 pixels, each a structure of arrays (ps_tile), stored one after the other. A tile
 * is the unit of work: one thread owns it at a time, so nothing needs a lock.
 */
#ifndef FILM_GBUFFER_H
#define FILM_GBUFFER_H

#include "base/error.h"
#include "trace/trace.h"
#include <stdbool.h>

struct gbuffer {
    size_t width, height;
    uint32_t tiles_across, tiles_down, tile_count;
    ps_tile *tiles; /* 64-byte aligned, owned */
    ps_rgb *direct; /* direct irradiance, tile_count * PS_TILE_PIXELS, owned */
};

ps_result gbuffer_create(size_t width, size_t height, struct gbuffer *gbuffer, struct error *error);
void gbuffer_release(struct gbuffer *gbuffer);

/* Bytes that the buffer takes. */
size_t gbuffer_bytes(const struct gbuffer *gbuffer);

/* Column and row of a lane; false if it lies outside of the picture. */
bool gbuffer_pixel(const struct gbuffer *gbuffer, uint32_t tile, uint32_t lane, uint32_t *x,
                   uint32_t *y);

/* Fills tile `tile` with what the camera sees through points `jitter_x`, `jitter_y` (0..1) of its
 * pixels, and zeroes its accumulators. */
void gbuffer_trace_tile(struct gbuffer *gbuffer, const struct trace *trace,
                        const struct camera *camera, uint32_t tile, float jitter_x, float jitter_y);

/* Forgets the indirect light of an unfinished pass. */
void gbuffer_clear_indirect(struct gbuffer *gbuffer);

#endif
