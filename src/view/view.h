/* view.h: what the camera sees: fills the G-buffer.
 *
 * From each pixel a path runs over mirrors, gloss and glass to the first diffuse surface, where it
 * ends and indirect light is gathered; a surface of several lobes chooses one by chance, anew in each
 * pass, so that passes average over all. On the way the path collects what is emitted, and what gloss
 * reflects of the lights.
 */
#ifndef VIEW_VIEW_H
#define VIEW_VIEW_H

#include "direct/direct.h"

struct view_pass {
    struct lighting
        lighting; /* scene and rays; and for what is emitted, and what gloss reflects of the lights */
    struct gbuffer *gbuffer;
    uint64_t seed;
    /* Instead of the G-buffer: the rays that paths end with and what they met, for each lane; lanes whose
     * paths end nowhere are left as they are. NULL: the G-buffer is filled. */
    ps_ray *rays;
    ps_hit *hits;
    bool surfaces_alone; /* the G-buffer is filled without the light that is collected on the way */
};

/* Where lanes of a tile look. */
struct view_points {
    size_t count;                   /* of lanes that look anywhere */
    uint32_t of_pixel;              /* so many that follow each other look at one pixel */
    uint32_t lanes[PS_TILE_PIXELS]; /* these, compact ones next to each other */
    float x[PS_TILE_PIXELS], y[PS_TILE_PIXELS]; /* of each lane, in pixels of the picture */
    uint64_t indices[PS_TILE_PIXELS];           /* of each lane's random numbers */
};

/* The pixels of a tile of the picture, by its number there, all at the same place (jitter_x, jitter_y) from their upper
 * left corners, in pass `number`. */
void view_pixels(const struct gbuffer *gbuffer, uint32_t tile_number, uint32_t number,
                 float jitter_x, float jitter_y, struct view_points *points);

/* Fills tile `index`, and zeroes its accumulators; or fills `rays` and `hits`. */
void view_trace(const struct view_pass *pass, const struct view_points *points, uint32_t index);

#endif
