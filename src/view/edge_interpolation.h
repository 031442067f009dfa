/* edge_interpolation.h: the indirect light of a camera sample, from that of the pixels around.
 *
 * A weighted mean over the 5x5 pixels around that see the sample's surface,
 *
 *     E = sum over i of w_i E_i / sum over i of w_i,   w_i = 1 / |x_i - x|^2
 *
 * with x the sample's point and x_i those of the pixels (inverse distance weighting: Shepard 1968,
 * "A two-dimensional interpolation function for irregularly-spaced data"): light changes fast in
 * corners and under eaves, and what two pixels see may lie far apart. Where no pixel around sees
 * the surface (for stochastic samples: fewer than six), the pixels of the tile that do are used, by
 * w_i^2: many of them may lie far away and in other light, such as a caustic before a glass that
 * reflects what lies beside it. Failing that, pixels around of the same object, or any that see a
 * surface, are used. The indirect light of a sample by rays of its own would be far noisier.
 */
#ifndef VIEW_EDGE_INTERPOLATION_H
#define VIEW_EDGE_INTERPOLATION_H

#include "film/gbuffer.h"

enum { EDGE_NEIGHBOURS = 32 }; /* 5x5, and up to whole vectors */

/* The pixels around one, for all of its samples. */
struct edge_neighbours {
    uint32_t object[EDGE_NEIGHBOURS]; /* PS_NO_OBJECT: sees no surface, or there is no pixel */
    float x[EDGE_NEIGHBOURS], y[EDGE_NEIGHBOURS], z[EDGE_NEIGHBOURS];
    float normal_x[EDGE_NEIGHBOURS], normal_y[EDGE_NEIGHBOURS], normal_z[EDGE_NEIGHBOURS];
    float r[EDGE_NEIGHBOURS], g[EDGE_NEIGHBOURS],
        b[EDGE_NEIGHBOURS]; /* indirect irradiance, W/m^2 */
    float weight[EDGE_NEIGHBOURS];
    float radiance_r[EDGE_NEIGHBOURS], radiance_g[EDGE_NEIGHBOURS], radiance_b[EDGE_NEIGHBOURS];
    float splatted[3][EDGE_NEIGHBOURS]; /* see struct gbuffer */
};

void edge_neighbours_find(const struct gbuffer *gbuffer, uint32_t x, uint32_t y,
                          struct edge_neighbours *neighbours);

/* Sets the indirect light of a sample, a lane of the only tile of `samples`, that lies in pixel (x,
 * y). `stochastic`: lens, gloss or glass decided what it sees. */
void edge_interpolate(const struct gbuffer *gbuffer, const struct edge_neighbours *neighbours,
                      uint32_t x, uint32_t y, bool stochastic, const struct gbuffer *samples,
                      uint32_t lane);

#endif
