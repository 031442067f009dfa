/* bandwidth.h: how much of a full bundle's disc a pixel takes (step 3 of placement.h).
 *
 * Light from close by changes over short ways, so the disc should be small near the photon and may
 * be large far from it. If each splat had one radius for all of its pixels, by how far its own axis
 * runs, the discs that meet at a pixel would differ in size, and their sum would not be 1 (a
 * sample-point estimator: Silverman 1986, "Density estimation", section 5.3). Even light would be
 * up to 8 % too bright or too dark where radii change from place to place. So the pixel chooses.
 * Along direction w it lies at distance t from the plane of the photon, and the photons that it
 * sees around that place count within
 *
 *     h = c t / (1 + c s)        and  narrowest <= h <= widest
 *
 * with c the bandwidth scale and s the change of t across the bundle, over the pixel's own surface.
 * All photons of that plane then agree about h (but for the limits, which go by the splat), and
 * even light comes out even. As c grows h tends to t / s: a disc that just touches the crease where
 * both planes meet. A footprint of radius c d around a hit at distance d holds all pixels of a
 * plane that take in the axis, since from t = d + s |x| and |x| < h follows |x| < c d.
 */
#ifndef PLACEMENT_BANDWIDTH_H
#define PLACEMENT_BANDWIDTH_H

#include <math.h>
#include <psplat/types.h>

/* Steeper surfaces are taken to be no steeper; those that face away are not lit, whatever comes
 * out. */
#define BANDWIDTH_LEAST_FACING 1e-3f

/* h in radii of the splat, with all that can be worked out once for all pixels. */
struct bandwidth {
    float by_distance;    /* c / R */
    float spread;         /* c R: u and v are axes divided by R */
    float tilt_u, tilt_v; /* c times the slope of the photon's plane */
    float narrowest, widest;
};

/* Compilers make vectors of it: no calls, no branches. `facing`: the cosine at the pixel; normal_u,
 * normal_v: its normal along the axes divided by R; `distance`: t. */
static inline float bandwidth_at(const struct bandwidth *width, float distance, float facing,
                                 float normal_u, float normal_v)
{
    facing = facing > BANDWIDTH_LEAST_FACING ? facing : BANDWIDTH_LEAST_FACING;
    float a = normal_u * width->spread - width->tilt_u * facing;
    float b = normal_v * width->spread - width->tilt_v * facing;
    float h = width->by_distance * distance * facing / (facing + sqrtf(a * a + b * b));
    h = h < width->widest ? h : width->widest;
    return h > width->narrowest ? h : width->narrowest;
}

#endif
