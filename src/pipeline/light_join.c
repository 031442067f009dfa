#include "pipeline/light_join.h"

#include "film/pair_mean.h"

#define REACH 2 /* pixels to each side */

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
