/* short_range_light.h: the light that splats of a pass leave out, pixel by pixel.
 *
 * It is gathered with few rays a pixel (short_range_gather.h), and becomes a mean over the window
 * that splats are interleaved over, or would be if they were fewer and larger (geometry_filter.h).
 * Beside a thing no larger than a pixel, and along contacts, that is too wide. So a pixel whose own
 * rays found something else than the mean, by D with a variance of s^2 (both of the sum of its
 * channels), goes from the mean to its own by the part
 *
 *     max(0, 1 - (2 s / D)^2)
 *
 * which is next to 1 where they surely differ, and 0 where that may be chance (the garrote of Gao
 * 1998, "Wavelet shrinkage denoising using the non-negative garrote").
 */
#ifndef SHORT_RANGE_SHORT_RANGE_LIGHT_H
#define SHORT_RANGE_SHORT_RANGE_LIGHT_H

#include "base/parallel.h"
#include "film/gbuffer.h"

struct gathered_light {
    float distance;    /* from within which it comes, in this pass; 0: none is left */
    ps_rgb *found;     /* irradiance, a value for each lane of each tile; owned; NULL: none yet */
    float *variances;  /* of that, of its channels' sum; likewise */
    ps_rgb *joined;    /* room for its means, likewise */
    uint8_t *averaged; /* how many pixels they are taken over, likewise */
    /* For short_range_pilot.h, a value for each tile of the picture; likewise. */
    float *ray_variances; /* of what single rays find there */
    float *noises;        /* its root, there and around */
    double mean_noise;
    int radius;                    /* pixels to each side of those means' windows */
    const struct gbuffer *gbuffer; /* borrowed, in the pass */
};

/* So many rays a pixel, and those that it is averaged with, have less noise than the splats of so
 * many paths: both fall by the root of their number, nearly. */
uint32_t gathered_light_rays(uint64_t paths);

/* Starts a pass in which light from within a distance is left, and makes room where there is none.
 * `interleave`: n. */
ps_result gathered_light_begin(struct gathered_light *near, const struct gbuffer *gbuffer,
                               float distance, uint32_t interleave, struct workers *workers,
                               struct error *error);
/* What that takes for a G-buffer of this size. */
size_t gathered_light_bytes(const struct gbuffer *gbuffer);
void gathered_light_release(struct gathered_light *near);

/* Adds what was found to the G-buffer's tiles, without weight. */
void gathered_light_end(struct gathered_light *near, struct gbuffer *gbuffer,
                        struct workers *workers);

#endif
