/* light_sampling.c: what the kinds of light share; see light_kinds.h. */
#include "scene/light_kinds.h"

/* How far outside of the bounding sphere rays start, in radii: more than rounding, so that a corner
 * that touches the sphere is not behind them. */
#define OUTSIDE 1e-3f

/* The unit square to the unit disc: squares around the middle become rings, so that neighbours stay
 * neighbours. Shirley and Chiu 1997, "A low distortion map between disk and square". */
static void concentric_disc(float u1, float u2, float *x, float *y)
{
    float a = 2.0f * u1 - 1.0f, b = 2.0f * u2 - 1.0f;
    float radius, angle;
    if (a == 0.0f && b == 0.0f) {
        *x = *y = 0.0f;
        return;
    }
    if (fabsf(a) > fabsf(b)) {
        radius = a;
        angle = PS_PI / 4.0f * (b / a);
    } else {
        radius = b;
        angle = PS_PI / 2.0f - PS_PI / 4.0f * (a / b);
    }
    *x = radius * cosf(angle);
    *y = radius * sinf(angle);
}

ps_ray light_ray_into_scene(const struct light_bounds *bounds, ps_vec3 towards, float u1, float u2)
{
    ps_vec3 u, v;
    float x, y;
    ps_frame(towards, &u, &v);
    concentric_disc(u1, u2, &x, &y);
    ps_vec3 origin = ps_add_scaled(bounds->center, bounds->radius * (1.0f + OUTSIDE), towards);
    origin = ps_add_scaled(origin, bounds->radius * x, u);
    origin = ps_add_scaled(origin, bounds->radius * y, v);
    return (ps_ray){origin, 0.0f, ps_scale(towards, -1.0f), INFINITY};
}

float light_scene_area(const struct light_bounds *bounds)
{
    return PS_PI * bounds->radius * bounds->radius;
}

ps_vec3 light_cone_direction(ps_vec3 axis, float versine, float u1, float u2)
{
    ps_vec3 u, v;
    ps_frame(axis, &u, &v);
    float below = u1 * versine, phi = 2.0f * PS_PI * u2;
    float radius = sqrtf(below * (2.0f - below));
    ps_vec3 in_plane = ps_add_scaled(ps_scale(u, radius * cosf(phi)), radius * sinf(phi), v);
    return ps_normalize(ps_add_scaled(in_plane, 1.0f - below, axis));
}

float light_versine_of_sine2(float sine2)
{
    return sine2 / (1.0f + sqrtf(ps_max(1.0f - sine2, 0.0f)));
}

ps_vec3 light_any_direction(float u1, float u2)
{
    return light_cone_direction((ps_vec3){0, 0, 1}, 2.0f, u1, u2);
}

bool light_take_half(float *u)
{
    bool second = *u >= 0.5f;
    *u = second ? 2.0f * *u - 1.0f : 2.0f * *u;
    return second;
}
