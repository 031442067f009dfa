/* box.h: carries photons to the surfaces they light.
 *
 * Hoet 2014, section 3.3: an orthographic box around the first hit y of the photon's ray, axis w
 * along the ray, half-width R. Three rules say where the box begins:
 *
 *   a number  The thesis: that far before y. Where light arrives at a slope the lit surface leaves
 *             the box or shadows itself; 7 to 10 % of a Cornell box's light is lost, at any R.
 *   auto      b = min(d, R tan(theta) + R/2) and depth R tan(theta) + R: room for the slope theta
 *             at y.
 *   full      From the photon itself, whose tangent plane is where the bundle starts: each ray of
 *             the bundle lights what it meets first, so edges that the central ray misses get
 *             their light (after Herzog et al. 2007, "Global illumination using photon ray
 *             splatting").
 *
 * The size follows the distance d travelled, R = min(size, follow * d) but no less than a part of
 * size (0.3; 0.6 after the first bounce, or where light from close by is left to gather rays), as a photon
 * differential would: light from close by, in a corner, makes small splats. Nor does it follow below the n x n
 * pixels that interleaved splats are averaged over in the end. The box of a full bundle is as wide as its pixels'
 * sizes ask for (bandwidth.h, extent.h). Where photons were merged, `size` grows with the square root of their
 * number (see grow).
 */
#ifndef SPLAT_FOOTPRINT_H
#define SPLAT_FOOTPRINT_H

#include "plugin/shared_params.h"
#include "scene/camera.h"
#include "splat/splat.h"
#include <stdbool.h>

/* Slopes (tangents) past this are treated as this: 84 degrees, where 1 % of the energy arrives. */
#define FOOTPRINT_STEEPEST 10.0f

/* The cosine under which a photon's light leaves; no less than a 64th, under which 0.02 % of it does. */
float footprint_cosine(const ps_photon *photon);

struct footprint_scene {
    float radius;         /* of the scene */
    float surface_offset; /* see ps_pass */
    float automatic_size; /* half-width where the settings leave it open */
    float automatic_near; /* how short-range light is near there */
    uint64_t seed;        /* rotates the frames */
    const struct camera *camera;
    uint32_t interleave;   /* see interleaved.h */
    float gather_distance; /* of the light that splats leave to gather rays; 0: none */
};

/* How far above its photon's tangent plane a full bundle of that half-width starts. */
float footprint_clearance(float surface_offset, float half_width, bool hollow);

/* The half-width that light paths so many in a pass deserve. Noise grows as splats shrink and blur as
 * they grow; measured, the error is least at a size that falls by the fourth root of the paths, and by the
 * fifth from 100,000 on (in the Cornell box 66 mm there, 50 for 400,000). Later passes (from 0) shrink it by
 * p^((alpha - 1) / 2), alpha = 2/3, so that the mean of more and more passes loses noise and blur alike
 * (Knaus and Zwicker 2011, "Progressive photon mapping: a probabilistic approach").
 *
 * What lights the scene is `light_spread` wide (photons.h; 0: not known). A narrow pool of light throws sharp
 * shadows, as a small light does, so splats become smaller where that is little beside the scene. */
float footprint_automatic_size(float scene_radius, float light_spread, uint64_t paths,
                               uint32_t pass);

/* How short-range light has to come from for splats to leave part of it to gather rays (gather_share.h): two and a half
 * half-widths of the first pass of 100,000 paths. More of them have smaller splats; if the distance shrank with
 * these, what lies just past it would be blurred as much as before, for ever. 0 where bundles don't start at their
 * photons and follow the distance. (After the bias compensation of virtual point lights: Kollig and Keller
 * 2006, "Illumination in the presence of weak singularities".) */
float footprint_gather_distance(const struct footprint_scene *scene,
                                const struct footprint_params *settings, uint64_t paths);

/* That distance where the settings leave the size open. */
float footprint_automatic_near(float scene_radius, float light_spread, uint64_t paths);

/* Half-width of the disc that a photon's light may fill. */
float footprint_widest(const struct footprint_scene *scene, const struct footprint_params *settings,
                       const ps_photon *photon);

/* The same where the light travels so far. */
float footprint_half_width(const struct footprint_scene *scene,
                           const struct footprint_params *settings, const ps_photon *photon,
                           float distance);

/* In place of the hit of a bundle that meets nothing: a point of its axis, with a normal of 0. */
void footprint_stand_in(const ps_photon *photon, float distance, ps_hit *hit);

/* Places the boxes of n photons whose rays met `hits`; see ps_host.place_footprints. A half-width of 0 makes a
 * splat that lights nothing. */
void footprint_place(const struct footprint_scene *scene, const struct footprint_params *settings,
                     const ps_photon *photons, const ps_hit *hits, const float *half_widths,
                     size_t n, struct splat *splats);

/* Lets a full bundle start so far above its photon's tangent plane. */
void footprint_start(const ps_photon *photon, float clearance, struct splat *splat);

/* Cuts the far end of a splat to what its map holds (resolution^2 depths). */
void footprint_cut(struct splat *splat, const float *depths, uint32_t resolution);

/* Opens full bundles, for visibilities that follow their rays: they get no end where depth is
 * automatic. Maps are one-sided (a pixel before the map's depth is lit), since a ray that went on past
 * a point before it met anything must have passed it: where surfaces end within a texel (edges seen
 * against what lies farther away, walls that the bundle sticks through, Hoet 2014, section 3.3), a
 * two-sided test would shadow them falsely, half a texel wide. The plane of the photon keeps what lies
 * behind it dark. */
void footprint_open(const struct footprint_params *settings, struct splat *splats, size_t n);

/* Depth tolerance of splats with maps. A pixel is compared with the texel that it
 * falls into, so its depth may differ by the slope of its surface times its distance to the texel's
 * centre, half a diagonal at most. A bias by slope grants that and little more: 0.75 texels *
 * tan(theta), theta between the light and the pixel's normal. Twice as much gives back 0.3 % of the
 * light in creases, and loses the shadow of a plate 10 cm before a wall. A constant bias either shadows
 * slopes (acne, and energy lost) or leaks at contacts; it stays selectable, for comparison with the
 * thesis. */
void footprint_set_bias(const struct footprint_params *settings, struct splat *splats, size_t n);

#endif
