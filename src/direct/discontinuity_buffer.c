#include "direct/discontinuity_buffer.h"

#include "film/geometry_filter.h"

#define REACH 2 /* pixels to each side */
#define SIDE (2 * REACH + 1)

void discontinuity_buffer_runs(const struct gbuffer *gbuffer, uint32_t tile, uint32_t pass,
                               uint32_t samples, struct light_runs *runs)
{
    runs->count = SIDE * SIDE;
    for (uint32_t run = 0; run < SIDE * SIDE; run++)
        runs->first[run] = ((uint64_t)pass * SIDE * SIDE + run) * samples;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        gbuffer_pixel(gbuffer, tile, lane, &x, &y);
        runs->of_lane[lane] = (uint8_t)(y % SIDE * SIDE + x % SIDE);
    }
}

void discontinuity_buffer(struct gbuffer *gbuffer, struct workers *workers)
{
    ps_rgb *found = gbuffer->direct;
    struct geometry_filter mean = {.gbuffer = gbuffer,
                                   .occlusion = gbuffer->occlusion,
                                   .radius = REACH,
                                   .from = found,
                                   .to = gbuffer->direct_scratch};
    geometry_filter_apply(&mean, workers);
    gbuffer->direct = gbuffer->direct_scratch;
    gbuffer->direct_scratch = found;
}
