/* math.h: vectors, colours and sampling routines that core and plugins share. */
#ifndef PSPLAT_MATH_H
#define PSPLAT_MATH_H

#include <math.h>
#include <psplat/types.h>

#define PS_PI 3.14159265358979323846f

/* The smaller and the larger of two; `b` where they do not compare (NaN). Made for inner loops:
 * what fmaxf promises about NaN costs a call. */
static inline float ps_min(float a, float b)
{
    return a < b ? a : b;
}

static inline float ps_max(float a, float b)
{
    return a > b ? a : b;
}

static inline ps_vec3 ps_add(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline ps_vec3 ps_subtract(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline ps_vec3 ps_scale(ps_vec3 a, float s)
{
    return (ps_vec3){a.x * s, a.y * s, a.z * s};
}

/* a + s * b */
static inline ps_vec3 ps_add_scaled(ps_vec3 a, float s, ps_vec3 b)
{
    return (ps_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline float ps_dot(ps_vec3 a, ps_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline ps_vec3 ps_cross(ps_vec3 a, ps_vec3 b)
{
    return (ps_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline float ps_length(ps_vec3 a)
{
    return sqrtf(ps_dot(a, a));
}

static inline ps_vec3 ps_normalize(ps_vec3 a)
{
    return ps_scale(a, 1.0f / ps_length(a));
}

/* Whether two vectors are the very same. */
static inline int ps_same(ps_vec3 a, ps_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static inline ps_rgb ps_rgb_add(ps_rgb a, ps_rgb b)
{
    return (ps_rgb){a.r + b.r, a.g + b.g, a.b + b.b};
}

static inline ps_rgb ps_rgb_scale(ps_rgb a, float s)
{
    return (ps_rgb){a.r * s, a.g * s, a.b * s};
}

static inline ps_rgb ps_rgb_multiply(ps_rgb a, ps_rgb b)
{
    return (ps_rgb){a.r * b.r, a.g * b.g, a.b * b.b};
}

static inline float ps_rgb_maximum(ps_rgb a)
{
    return ps_max(a.r, ps_max(a.g, a.b));
}

/* Rec.709 luminance */
static inline float ps_luminance(ps_rgb a)
{
    return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b;
}

/* Completes unit vector w to a right-handed orthonormal frame u, v, w. Duff et al. 2017, "Building
 * an orthonormal basis, revisited": no branch, no loss of precision near the poles. */
static inline void ps_frame(ps_vec3 w, ps_vec3 *u, ps_vec3 *v)
{
    float sign = copysignf(1.0f, w.z);
    float a = -1.0f / (sign + w.z);
    float b = w.x * w.y * a;
    *u = (ps_vec3){1.0f + sign * w.x * w.x * a, sign * b, -sign * w.x};
    *v = (ps_vec3){b, sign + w.y * w.y * a, -w.y};
}

/* Direction around unit vector n with density cos(theta)/pi, from two numbers in [0,1). */
static inline ps_vec3 ps_cosine_direction(ps_vec3 n, float u1, float u2)
{
    ps_vec3 u, v;
    ps_frame(n, &u, &v);
    float radius = sqrtf(u1), phi = 2.0f * PS_PI * u2;
    float height = sqrtf(ps_max(1.0f - u1, 0.0f));
    ps_vec3 in_plane = ps_add_scaled(ps_scale(u, radius * cosf(phi)), radius * sinf(phi), v);
    return ps_normalize(ps_add_scaled(in_plane, height, n));
}

/* The ray from a surface point to the side of its normal; `offset` (ps_pass.surface_offset) keeps
 * it from meeting its own surface. */
static inline ps_ray ps_leave_surface(ps_vec3 position, ps_vec3 normal, ps_vec3 direction,
                                      float offset)
{
    return (ps_ray){ps_add_scaled(position, offset, normal), 0.0f, direction, INFINITY};
}

/* The packet's lane becomes that ray. */
static inline void ps_packet_set(ps_ray_packet *packet, size_t lane, ps_ray ray)
{
    packet->origin_x[lane] = ray.origin.x;
    packet->origin_y[lane] = ray.origin.y;
    packet->origin_z[lane] = ray.origin.z;
    packet->tnear[lane] = ray.tnear;
    packet->direction_x[lane] = ray.direction.x;
    packet->direction_y[lane] = ray.direction.y;
    packet->direction_z[lane] = ray.direction.z;
    packet->tfar[lane] = ray.tfar;
}

/* Direction uniform over the cone around unit vector axis whose half angle has cosine cos_limit. */
static inline ps_vec3 ps_cone_direction(ps_vec3 axis, float cos_limit, float u1, float u2)
{
    ps_vec3 u, v;
    ps_frame(axis, &u, &v);
    float height = 1.0f - u1 * (1.0f - cos_limit), phi = 2.0f * PS_PI * u2;
    float radius = sqrtf(ps_max(1.0f - height * height, 0.0f));
    ps_vec3 in_plane = ps_add_scaled(ps_scale(u, radius * cosf(phi)), radius * sinf(phi), v);
    return ps_normalize(ps_add_scaled(in_plane, height, axis));
}

#endif
