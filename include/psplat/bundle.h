/* bundle.h: the rays of a splat's bundle, for visibilities.
 *
 * A bundle's rays are parallel to axis_w and start on a plane, which may be tilted. A ray is named
 * by its place (u, v) across the bundle and a point on it by its depth t along axis_w, all in scene
 * units from the splat's centre.
 */
#ifndef PSPLAT_BUNDLE_H
#define PSPLAT_BUNDLE_H

#include <psplat/host.h>
#include <psplat/math.h>
#include <psplat/param.h>

/* How many walls a splat has: a plugin's own splats may claim anything. */
static inline uint32_t ps_boundary_count(const ps_splat *splat)
{
    return splat->boundary_count < PS_MOST_BOUNDARIES ? splat->boundary_count : PS_MOST_BOUNDARIES;
}

/* Where a point lies in a bundle: (u, v, t). */
static inline ps_vec3 ps_bundle_place(const ps_splat *splat, ps_vec3 point)
{
    ps_vec3 d = ps_subtract(point, splat->centre);
    return (ps_vec3){ps_dot(d, splat->axis_u), ps_dot(d, splat->axis_v), ps_dot(d, splat->axis_w)};
}

static inline ps_vec3 ps_bundle_point(const ps_splat *splat, float u, float v, float t)
{
    ps_vec3 point = ps_add_scaled(splat->centre, u, splat->axis_u);
    point = ps_add_scaled(point, v, splat->axis_v);
    return ps_add_scaled(point, t, splat->axis_w);
}

/* The depth at which the ray at (u, v) starts. */
static inline float ps_bundle_start(const ps_splat *splat, float u, float v)
{
    return splat->start_depth + u * splat->start_slope_u + v * splat->start_slope_v;
}

/* Where texel i of `side` texels across a splat has its centre. */
static inline float ps_texel_centre(const ps_splat *splat, uint32_t side, uint32_t i)
{
    return (2.0f * ((float)i + 0.5f) / (float)side - 1.0f) * splat->half_width;
}

/* Opens full bundles, for visibilities that follow their rays: they get no end where depth is
 * automatic. Maps are one-sided (a pixel before the map's depth is lit), since a ray that went on past
 * a point before it met anything must have passed it: where surfaces end within a texel (edges seen
 * against what lies farther away, walls that the bundle sticks through, Hoet 2014, section 3.3), a
 * two-sided test would shadow them falsely, half a texel wide. The plane of the photon keeps what lies
 * behind it dark. */
static inline void ps_open_full_bundles(const ps_footprint_settings *settings, ps_splat *splats,
                                        size_t n)
{
    if (settings->step_back_rule != 1 || settings->depth > 0)
        return;
    for (size_t i = 0; i < n; i++)
        splats[i].far_depth = INFINITY;
}

/* Depth tolerance of splats with maps of `side` texels. A pixel is compared with the texel that it
 * falls into, so its depth may differ by the slope of its surface times its distance to the texel's
 * centre, half a diagonal at most. A bias by slope (choice 0) grants that and little more: 0.75 texels *
 * tan(theta), theta between the light and the pixel's normal. Twice as much gives back 0.3 % of the
 * light in creases, and loses the shadow of a plate 10 cm before a wall. A constant bias either shadows
 * slopes (acne, and energy lost) or leaks at contacts; it stays selectable, for comparison with the
 * thesis. */
static inline void ps_set_bias(ps_number_or_choice bias, uint32_t side, ps_splat *splats, size_t n)
{
    static const float slope_texels = 0.75f;
    static const float flat_texels = 0.1f; /* where the light arrives at a right angle */
    for (size_t i = 0; i < n; i++) {
        float texel = 2.0f * splats[i].half_width / (float)side;
        int by_slope = bias.choice >= 0;
        splats[i].bias_constant = by_slope ? flat_texels * texel : (float)fmin(bias.number, 1e9);
        splats[i].bias_slope = by_slope ? slope_texels * texel : 0.0f;
    }
}

#endif
