/* footprint.h: the orthographic box around a bundle (steps 4, 5 and 7 of placement.h).
 *
 * Axis w runs along the photon's ray, the origin is the ray's first hit y, and the box reaches from
 * R before the axis to R beyond it, across. Three rules say where it begins (Hoet 2014, section
 * 3.3):
 *
 *   a number  The thesis: that far before y. Where light arrives at a slope the lit surface leaves
 *             the box or shadows itself, and light is lost at any R.
 *   auto      b = min(d, R tan(theta) + R/2) and depth R tan(theta) + R: room for the slope theta
 *             at y.
 *   full      From the photon itself, whose tangent plane is where the bundle starts: each ray of
 *             the bundle lights what it meets first, so edges that the central ray misses get
 *             their light (after Herzog et al. 2007, "Global illumination using photon ray
 *             splatting").
 */
#ifndef PLACEMENT_FOOTPRINT_H
#define PLACEMENT_FOOTPRINT_H

#include "placement/placement.h"

/* Slopes (tangents) past this are treated as this: 84 degrees, where 1 % of the energy arrives. */
#define FOOTPRINT_STEEPEST 10.0f

/* The cosine under which a photon's light leaves; no less than a 64th, under which 0.02 % of it
 * does. */
float footprint_cosine(const ps_photon *photon);

/* How far above its photon's tangent plane a full bundle of that radius starts. */
float footprint_clearance(float surface_offset, float radius, bool hollow);

/* In place of the hit of a bundle that meets nothing: a point of its axis, with a normal of 0. */
void footprint_stand_in(const ps_photon *photon, float distance, ps_hit *hit);

/* Of a photon whose ray met `hit`; `largest`: radius_largest. A radius of 0 makes a splat that
 * lights nothing. */
struct splat footprint_place(const struct placement_scene *scene,
                             const struct footprint_params *settings, const ps_photon *photon,
                             const ps_hit *hit, float largest, float radius);

/* Lessens the radii of n full bundles, which are the largest (or 0: left out), to what the pixels
 * of anything that the bundle meets may ask for (step 4 of placement.h). Each pixel takes its own
 * part of a bundle's disc, as wide as its distance from the photon allows (bandwidth.h), and the
 * box must hold all these parts. Where the axis meets something near, a part of the bundle may go
 * by and light what lies far behind with the whole disc; where the axis meets nothing, what stands
 * beside it may be lit all the same. Rays over the largest disc find both.
 *
 * A bundle that meets nothing gets a hit on its axis, as far away as the nearest thing beside it
 * (but no nearer than its radius), with a normal of 0, as its slope is anything. One whose disc
 * meets nothing either stays as large: what is thinner than the space between the rays may stand
 * there, as mullions before the sky do, which lost a sixth of their light. Any thread. */
void footprint_find_extents(const struct placement *placement, const ps_photon *photons, size_t n,
                            ps_hit *hits, float *radii);

/* Lets a full bundle start so far above its photon's tangent plane. */
void footprint_start(const ps_photon *photon, float clearance, struct splat *splat);

/* Cuts the far end of a splat to what its map holds (resolution^2 depths). */
void footprint_cut(struct splat *splat, const float *depths, uint32_t resolution);

/* Opens full bundles, for visibilities that follow their rays: they get no end where depth is
 * automatic. Maps are one-sided (a pixel before the map's depth is lit), since a ray that went on
 * past a point before it met anything must have passed it: where surfaces end within a texel (edges
 * seen against what lies farther away, walls that the bundle sticks through, Hoet 2014, section
 * 3.3), a two-sided test would shadow them falsely, half a texel wide. The plane of the photon
 * keeps what lies behind it dark. */
void footprint_open(const struct footprint_params *settings, struct splat *splats, size_t n);

/* Depth tolerance of splats with maps. A pixel is compared with the texel that it
 * falls into, so its depth may differ by the slope of its surface times its distance to the texel's
 * centre, half a diagonal at most. A bias by slope grants that and little more: 0.75 texels *
 * tan(theta), theta between the light and the pixel's normal. Twice as much gives back
 * light in creases, and loses the shadow of what is close to a wall. A constant bias either shadows
 * slopes (acne, and energy lost) or leaks at contacts; it stays selectable, for comparison with the
 * thesis. */
void footprint_set_bias(const struct footprint_params *settings, struct splat *splats, size_t n);

#endif
