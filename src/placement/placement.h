/* placement.h: carries photons to the surfaces that they light: how large their footprints are, and
 * where.
 *
 * A photon i leaves x_i in direction w_i with power Phi_i; all the light that leaves around x_i in
 * that direction is its bundle of parallel rays. A point y with normal n that the bundle lights
 * gets the irradiance
 *
 *     E(y) = sum_i Phi_i K_h(y - x_i) max(0, -n.w_i) share(t) / (part of K_h that boundaries leave)
 *
 * with the difference taken across the bundle, K_h a kernel of radius h that integrates to 1, and t
 * the distance of y from the photon's tangent plane along w_i (Hoet 2014, section 3.3; Silverman
 * 1986, "Density estimation"). What each factor is, in the order in which this module works it out:
 *
 * 1. The radius R of N paths in pass p, in a scene of radius S whose light lands L wide (radius.h):
 *
 *        R = min(0.25 S, min(0.138 S, max(0.5 L, 0.055 S)) (N / 100000)^-a) (p + 1)^(-1/6)
 *
 *    a = 1/4 up to 100,000 paths, 1/5 from there on. The error of a kernel estimate is its
 *    variance, which falls as 1 / (N R^2), and the square of its bias, which grows with R; where
 *    light has sharp edges the bias of a pixel near one grows as R alone, and the best radius falls
 *    by about the fourth root of N. The shrinking over passes is that of progressive photon mapping
 *    with alpha = 2/3: the mean of ever more passes loses both (Knaus and Zwicker 2011). A narrow
 *    pool of light throws sharp shadows, hence L.
 *
 * 2. A photon that stands for m merged ones: R sqrt(m), at most max_merge_scale R. As many splats
 *    overlap as without merging, each as bright.
 *
 *    Light that only mirrors, glass and gloss have sent lands in caustics, where R is less the
 *    denser its photons lie (caustics.h).
 *
 * 3. Light from close by changes over short ways. At distance t the radius is bandwidth_scale * t,
 *    within bounds (radius.h), as a photon differential's footprint (Schjoth et al. 2007): one for
 *    each pixel where bundles start at their photons (bandwidth.h), else one for the splat, at its
 *    first hit.
 *
 * 4. The footprint is an orthographic box around the bundle (footprint.h). Where pixels choose
 *    their own radius, it holds the largest that any of them may take (footprint_find_extents).
 *
 * 5. It starts `step_back` before the first hit, or, at `full`, at the photon's own tangent plane,
 *    so that each ray of the bundle lights what it meets first (Herzog et al. 2007). Where a wall
 *    stands on that plane, rays would start behind it: the kernel is divided by the part before it
 *    (boundary.h, Jones 1993).
 *
 * 6. share(t) < 1 near to the photon's plane where gather rays find the rest (gather_share.h,
 *    short_range/short_range_gather.h; after Kollig and Keller 2006). They reach 2.5 R, of the R of
 *    pass 0 and at most 100,000 paths: if that shrank with more, what lies just past it would stay
 *    as blurred as it was.
 *
 * 7. A depth map tells what the bundle meets first, with a bias by the receiver's slope
 *    (footprint.h).
 *
 * The constants are measured: the least error over the shipped scenes (docs/notes/method.md).
 */
#ifndef PLACEMENT_PLACEMENT_H
#define PLACEMENT_PLACEMENT_H

#include "placement/caustics.h"
#include "placement/splat.h"
#include "plugin/shared_params.h"
#include "scene/camera.h"
#include <psplat/host.h>
#include <stdbool.h>

/* What footprints need to know of the scene and the pass. Lengths in scene units. */
struct placement_scene {
    float radius;           /* of the scene */
    float surface_offset;   /* see ps_pass */
    float automatic_radius; /* of footprints, where the settings leave it open (radius.h) */
    float automatic_gather_distance;
    uint64_t seed; /* turns the frames */
    const struct camera *camera;
    uint32_t interleave;             /* see interleaved.h */
    float gather_distance;           /* of the light that splats leave to gather rays; 0: none */
    const struct caustics *caustics; /* NULL: as other light */
};

struct placement {
    struct placement_scene scene;
    const struct footprint_params *settings;
    const ps_host *host; /* traces the rays that look around bundles */
    bool follows_rays;   /* the visibility tells for each ray of a bundle what it meets */
    bool has_maps;       /* by depth maps */
    /* Whether a splat may light anything; NULL: all may. */
    bool (*may_light)(const void *user, const struct splat *splat);
    const void *user;
};

/* Places the footprints of n <= PS_PATH_CHUNK photons whose rays met `hits`, which it uses up. A
 * radius of 0 makes a splat that lights nothing; to how many `may_light` gave that is returned. Any
 * thread. */
uint32_t placement_place(const struct placement *placement, const ps_photon *photons, ps_hit *hits,
                         size_t n, struct splat *splats);

#endif
