/* splat.h: a photon carried to the surface that it lights: its bundle of rays, its footprint and
 * its power.
 *
 * The footprint is an orthographic box around the first hit, or around a point of the axis beside
 * which something is met (footprint.h). A point p lies at depth t = (p - centre).axis_w, and is
 * inside where |(p - centre).axis_u|, |(p - centre).axis_v| <= radius and near_depth <= t <=
 * far_depth.
 */
#ifndef PLACEMENT_SPLAT_H
#define PLACEMENT_SPLAT_H

#include <psplat/types.h>

struct splat {
    /* A splat whose radius is 0 lights nothing; far_depth >= 0 until cut to a map. */
    ps_bundle bundle;
    float near_depth; /* relative to the centre; <= 0 */
    /* Of full bundles: where the photon's tangent plane, parallel to the start plane, crosses the
     * axis; each pixel takes as much of the disc around its own ray as bandwidth.h says, between
     * `narrowest` > 0 and `widest`; and where that is less than the footprint's, the bundle starts
     * as much nearer to the photon's plane. bandwidth_scale 0: all pixels take all of it, and
     * photon_depth says nothing. */
    float photon_depth, bandwidth_scale, narrowest, widest;
    /* Of full bundles that follow the distance: what lies this far from the photon's plane, or
     * farther, gets all of the light; what lies nearer, the less of it, the nearer. The rest is
     * gathered otherwise (short_range/short_range_gather.h). 0: all gets all. */
    float blend_distance;
    /* Lit where t <= map + constant + slope * tan(theta), slope >= 0, theta between the light and
     * the receiver's normal. */
    float bias_constant, bias_slope;
    ps_rgb power;  /* W */
    float merged;  /* photons that it stands for: how often its weight counts; 0 is as 1 */
    uint64_t path; /* of its photon */
};

#endif
