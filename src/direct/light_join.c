#include "direct/light_join.h"

#include "film/pair_mean.h"

#define REACH 2 /* pixels to each side */
#define SIDE (2 * REACH + 1)

void light_join_runs(const struct gbuffer *gbuffer, uint32_t tile, uint32_t pass, uint32_t samples,
                     struct light_runs *runs)
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

void light_join(struct gbuffer *gbuffer, uint32_t threads)
{
    ps_rgb *found = gbuffer->direct;
    struct pair_mean mean = {.gbuffer = gbuffer,
                             .met = gbuffer->met,
                             .reach = REACH,
                             .from = found,
                             .to = gbuffer->joined};
    pair_mean_take(&mean, threads);
    gbuffer->direct = gbuffer->joined;
    gbuffer->joined = found;
}
