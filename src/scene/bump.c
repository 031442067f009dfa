#include "scene/bump.h"

#include <float.h>
#include <psplat/math.h>

/* Of a map's blue: a normal that lies in the surface, or below it, is raised to this. */
#define LEAST_HEIGHT 0.01f

static ps_vec3 unit_or(ps_vec3 v, ps_vec3 otherwise)
{
    float length = ps_length(v);
    bool usable = length > 0.0f && length <= FLT_MAX;
    return usable ? ps_scale(v, 1.0f / length) : otherwise;
}

/* The gradient along the surface of what changes by slopes[0] with u and slopes[1] with v: the
 * vector in the plane of n whose products with dpdu and dpdv these are. */
static ps_vec3 surface_gradient(const float slopes[2], ps_vec3 n, ps_vec3 dpdu, ps_vec3 dpdv)
{
    float area = ps_dot(n, ps_cross(dpdu, dpdv));
    if (!(fabsf(area) > 0.0f))
        return (ps_vec3){0, 0, 0};
    ps_vec3 sum = ps_scale(ps_cross(dpdv, n), slopes[0]);
    return ps_scale(ps_add_scaled(sum, slopes[1], ps_cross(n, dpdu)), 1.0f / area);
}

static ps_vec3 project(ps_vec3 v, ps_vec3 n)
{
    return ps_add_scaled(v, -ps_dot(v, n), n);
}

ps_vec3 bump_bump(const struct pigment *height, ps_vec3 point, const float uv[2], float log_width,
                  ps_vec3 normal, ps_vec3 dpdu, ps_vec3 dpdv)
{
    if (pigment_is_constant(height))
        return normal;
    ps_vec3 gradient;
    if (height->kind == PIGMENT_IMAGE) {
        float slopes[2];
        pigment_uv_gradient(height, uv, log_width, slopes);
        gradient = surface_gradient(slopes, normal, dpdu, dpdv);
    } else {
        gradient = project(pigment_gradient(height, point), normal);
    }
    return unit_or(ps_subtract(normal, gradient), normal);
}

/* The map's vector at (u, v): x along u, y along v, z along the normal. */
static ps_vec3 map_vector(const struct texture *map, const float uv[2], float log_width)
{
    float rgba[4];
    texture_filter(map, uv[0], uv[1], log_width, rgba);
    float middle = map->raster.sample == RASTER_BYTE ? 128.0f / 255.0f : 0.5f;
    float scale = 1.0f / (1.0f - middle);
    return (ps_vec3){(rgba[0] - middle) * scale, (rgba[1] - middle) * scale,
                     fmaxf((rgba[2] - middle) * scale, LEAST_HEIGHT)};
}

ps_vec3 bump_normal_map(const struct texture *map, const float uv[2], float log_width,
                        ps_vec3 normal, ps_vec3 dpdu, ps_vec3 dpdv)
{
    const ps_vec3 none = {0, 0, 0};
    ps_vec3 along_u = unit_or(project(dpdu, normal), none);
    ps_vec3 along_v = ps_cross(normal, along_u);
    float side = ps_dot(along_v, dpdv);
    if (!(fabsf(side) > 0.0f))
        return normal;
    ps_vec3 vector = map_vector(map, uv, log_width);
    ps_vec3 bent = ps_scale(normal, vector.z);
    bent = ps_add_scaled(bent, vector.x, along_u);
    bent = ps_add_scaled(bent, side < 0.0f ? -vector.y : vector.y, along_v);
    return unit_or(bent, normal);
}
