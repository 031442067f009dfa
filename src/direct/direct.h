/* direct.h: light straight from the lights, by shadow rays or maps; and what surfaces and sky emit.
 *
 * Each light is sampled once for each point, or some of many (receivers.h); lights without a size
 * need no random numbers. Where gloss can also find a light by scattering, both ways are weighed
 * (Veach and Guibas 1995).
 */
#ifndef DIRECT_DIRECT_H
#define DIRECT_DIRECT_H

#include "direct/portals.h"
#include "direct/shadow_maps.h"
#include "film/gbuffer.h"

/* The lights, and how their shadows are found. */
struct lighting {
    const struct scene *scene;
    const struct trace *trace;
    const struct shadow_maps *maps; /* NULL: by shadow rays alone */
    const struct portals *portals;  /* through which the sky is looked for; NULL: all around */
    uint32_t choices;               /* lights that a point draws where it can't ask all */
    float light_threshold;          /* as in struct light_draws; 0: none */
};

/* Which random numbers choose points on lights; see ps_host.samples. */
struct light_numbers {
    uint64_t seed;
    uint32_t stream, set;
    const uint64_t *indices; /* one for each point */
};

/* Radiance that the surfaces hit reflect back along the rays, of light straight from the lights: of
 * those of some groups, as in ps_host.direct_radiance_of. */
void direct_radiance(const struct lighting *lighting, const ps_ray *rays, const ps_hit *hits,
                     const uint8_t *groups, size_t n, const struct light_numbers *numbers,
                     ps_rgb *radiance);

/* Radiance that what the rays met (or the sky) emits along them. `pdfs` (NULL: all 0) as in
 * ps_host.emitted_radiance. */
void emitted_radiance(const struct lighting *lighting, const ps_ray *rays, const ps_hit *hits,
                      const float *pdfs, size_t n, ps_rgb *radiance);

/* The random numbers of a tile's lanes: runs of indices, each for one lane or several. */
struct light_runs {
    size_t count;
    uint64_t first[PS_TILE_PIXELS];  /* where each run begins */
    uint8_t of_lane[PS_TILE_PIXELS]; /* which run a lane has */
};

/* Fills in the direct irradiance of a tile's lanes: the mean of `samples` shadow rays for each
 * light that has a size, with as many numbers of their runs. And, where the G-buffer has room for
 * it, that of the second half of them alone, what of both comes from lights that cast hard shadows,
 * and what the rays met. */
void direct_light_tile(const struct lighting *lighting, struct gbuffer *gbuffer, uint32_t tile,
                       uint64_t seed, const struct light_runs *runs, uint32_t samples);

#endif
