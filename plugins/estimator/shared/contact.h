/* contact.h: the variance of pixels in contact: in a crease, or in the shadow of what touches their
 * surface. Their light may change from pixel to pixel, where a denoiser that has a single pass
 * takes what sets a pixel apart for noise. Elsewhere it seldom does, and their variance is not
 * told: few samples know nothing of rare bright ones.
 */
#ifndef PSPLAT_ESTIMATOR_CONTACT_H
#define PSPLAT_ESTIMATOR_CONTACT_H

#include <psplat/plugin.h>

enum { CONTACT_RAYS = 4 }; /* rays of a point, the first ones, that look for what is near */

static inline float contact_mean_of_channels(ps_rgb light)
{
    return (light.r + light.g + light.b) * (1.0f / 3.0f);
}

/* Sets the variance of those points of a tile of which one of these rays went no farther than
 * their pixel is wide. `nearest`: the least distance of the rays of each point; `variance`: that of
 * the mean of the channels of its irradiance, by its samples, (W/m^2)^2. It counts as the mean over
 * the points at least: that of few samples is a poor estimate. Any thread. */
void contact_tell_variance(const ps_host *host, const ps_points *points, const float *nearest,
                           const float *variance, ps_tile *tile);

#endif
