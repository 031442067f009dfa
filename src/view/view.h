/* view.h: what the camera sees: fills the G-buffer.
 *
 * From each pixel a path runs over mirrors, gloss and glass to the first diffuse surface, where it
 * ends. Its radiance is
 *
 *     L = sum over the surfaces of the path of T_i (L_e + direct light reflected by gloss)
 *         + T albedo / pi (E_direct + E_indirect)
 *
 * with T_i and T the throughput from there to the camera. The sum is collected here; estimators
 * find E_indirect where the path ends. A surface of several lobes chooses one at random, anew in
 * each pass, so that passes average over all.
 */
#ifndef VIEW_VIEW_H
#define VIEW_VIEW_H

#include "direct/direct.h"

struct view_pass {
    /* Scene and rays; and for what is emitted, and what gloss reflects of the lights. */
    struct lighting lighting;
    struct gbuffer *gbuffer;
    uint64_t seed;
    /* Output: either the G-buffer (both NULL), or for each lane the last ray of its path and what
     * it met; lanes that meet no surface keep their values. */
    ps_ray *rays;
    ps_hit *hits;
    /* The G-buffer is filled without the radiance that is collected along the path. */
    bool without_light;
};

/* The camera samples of a tile. */
struct view_points {
    size_t count;                               /* of lanes that have one */
    uint32_t samples_of_pixel;                  /* so many consecutive lanes belong to one pixel */
    uint32_t lanes[PS_TILE_PIXELS];             /* those that have one, neighbours close together */
    float x[PS_TILE_PIXELS], y[PS_TILE_PIXELS]; /* of each lane, in pixels of the picture */
    uint64_t indices[PS_TILE_PIXELS];           /* of each lane's random numbers */
};

/* The pixels of a tile of the picture, by its number there, all at the same place (jitter_x,
 * jitter_y) from their upper left corners, in pass `number`. */
void view_pixels(const struct gbuffer *gbuffer, uint32_t tile_number, uint32_t number,
                 float jitter_x, float jitter_y, struct view_points *points);

/* Fills tile `index`, and zeroes its accumulators; or fills `rays` and `hits`. */
void view_trace(const struct view_pass *pass, const struct view_points *points, uint32_t index);

#endif
