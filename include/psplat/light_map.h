/* light_map.h: the scene as a light sees it through a square, for maps of what a light meets.
 *
 * A point of light looks by perspective (Williams 1978, "Casting curved shadows on curved
 * surfaces"): a spotlight through one square as wide as its cone, wide spotlights and point lights
 * through the six faces of a cube. A view in parallel serves light that comes from infinity.
 */
#ifndef PSPLAT_LIGHT_MAP_H
#define PSPLAT_LIGHT_MAP_H

#include <psplat/math.h>
#include <psplat/types.h>

/* The cosine of a cone's half angle. A wider spotlight would have all of its pixels near the rim of
 * one perspective map. */
#define PS_WIDEST_MAP_COSINE (1.0f / 3.0f)

/* A square that is looked through. */
typedef struct ps_light_view {
    ps_vec3 origin;     /* of all rays; in parallel, of the one in the middle */
    ps_vec3 axis, u, v; /* orthonormal; axis is where the middle ray goes, u and v the sides */
    float radius; /* half the width: at distance 1 along the axis; in parallel, in scene units */
    uint32_t parallel; /* 1: all rays go along the axis */
} ps_light_view;

/* The views that a light of PS_LIGHT_POINT needs: 1 or 6; 0 where it is dark. */
static inline uint32_t ps_light_view_count(const ps_light *light)
{
    if (!(ps_rgb_maximum(light->power) > 0.0f))
        return 0;
    return light->cos_cone < PS_WIDEST_MAP_COSINE ? 6 : 1;
}

/* View `face` of such a light: 0 looks along the light's axis, 1 to 5 are the other sides of the
 * cube. */
static inline ps_light_view ps_light_view_of(const ps_light *light, uint32_t face)
{
    ps_vec3 sides[3];
    float cosine = light->cos_cone;
    sides[0] = light->axis;
    ps_frame(light->axis, &sides[1], &sides[2]);
    return (ps_light_view){
        .origin = light->position,
        .axis = ps_scale(sides[face / 2], face % 2 ? -1.0f : 1.0f),
        .u = sides[(face / 2 + 1) % 3],
        .v = sides[(face / 2 + 2) % 3],
        .radius = cosine < PS_WIDEST_MAP_COSINE ? 1.0f : sqrtf(1.0f - cosine * cosine) / cosine,
    };
}

/* The ray through the place (x, y) of the square, both 0..1. It starts at tnear = `offset`, since a
 * light may lie on a surface; see ps_pass.surface_offset. */
static inline ps_ray ps_light_view_ray(const ps_light_view *view, float x, float y, float offset)
{
    ps_vec3 from = view->parallel ? view->origin : view->axis;
    from = ps_add_scaled(from, (2.0f * x - 1.0f) * view->radius, view->u);
    from = ps_add_scaled(from, (2.0f * y - 1.0f) * view->radius, view->v);
    if (view->parallel)
        return (ps_ray){from, offset, view->axis, INFINITY};
    return (ps_ray){view->origin, offset, ps_normalize(from), INFINITY};
}

#endif
