#include "scene/camera.h"

#include <assert.h>
#include <psplat/math.h>

static double half_tangent(double degrees)
{
    return tan(degrees * (3.14159265358979323846 / 360.0));
}

/* Of the picture at distance 1, or anywhere where it is orthographic. */
static double half_width_of(const struct camera_description *description, double aspect)
{
    if (description->kind == CAMERA_ORTHOGRAPHIC)
        return 0.5 * description->width;
    if (description->vertical_angle > 0)
        return half_tangent(description->vertical_angle) * aspect;
    return half_tangent(description->angle);
}

struct camera camera_from_description(const struct camera_description *description, size_t width,
                                      size_t height)
{
    assert(width > 0 && height > 0);
    double aspect = (double)width / (double)height;
    double half_width = half_width_of(description, aspect);
    double half_height = half_width / aspect;
    ps_vec3 view = ps_subtract(description->look_at, description->location);
    ps_vec3 forward = ps_normalize(view);
    ps_vec3 right = ps_normalize(ps_cross(forward, description->up));
    ps_vec3 up = ps_cross(right, forward);
    struct camera camera = {
        .orthographic = description->kind == CAMERA_ORTHOGRAPHIC,
        .location = description->location,
        .forward = forward,
        .across = ps_scale(right, (float)(2.0 * half_width / (double)width)),
        .down = ps_scale(up, (float)(-2.0 * half_height / (double)height)),
        .lens_u = ps_scale(right, (float)description->aperture),
        .lens_v = ps_scale(up, (float)description->aperture),
        .aperture = (float)description->aperture,
        .focus = description->focus > 0 ? (float)description->focus : ps_length(view),
    };
    camera.corner = ps_add_scaled(forward, (float)-half_width, right);
    camera.corner = ps_add_scaled(camera.corner, (float)half_height, up);
    return camera;
}

/* Moves the ray's start over the lens, and keeps where it is sharp. */
static ps_ray bend(const struct camera *camera, ps_ray ray, const float lens[2])
{
    float distance = camera->focus / ps_dot(ray.direction, camera->forward);
    ps_vec3 sharp = ps_add_scaled(ray.origin, distance, ray.direction);
    float radius = sqrtf(lens[0]), phi = 2.0f * PS_PI * lens[1];
    ray.origin = ps_add_scaled(ray.origin, radius * cosf(phi), camera->lens_u);
    ray.origin = ps_add_scaled(ray.origin, radius * sinf(phi), camera->lens_v);
    ray.direction = ps_normalize(ps_subtract(sharp, ray.origin));
    return ray;
}

ps_ray camera_ray(const struct camera *camera, float x, float y, const float lens[2])
{
    ps_vec3 point = ps_add_scaled(camera->corner, x, camera->across);
    point = ps_add_scaled(point, y, camera->down);
    ps_ray ray = {camera->location, 0.0f, ps_normalize(point), INFINITY};
    if (camera->orthographic) {
        ray.origin = ps_add(camera->location, ps_subtract(point, camera->forward));
        ray.direction = camera->forward;
    }
    return camera->aperture > 0.0f ? bend(camera, ray, lens) : ray;
}

struct camera camera_of_part(const struct camera *camera, float left, float top, float step)
{
    struct camera part = *camera;
    part.corner = ps_add_scaled(part.corner, left, camera->across);
    part.corner = ps_add_scaled(part.corner, top, camera->down);
    part.across = ps_scale(camera->across, step);
    part.down = ps_scale(camera->down, step);
    return part;
}

bool camera_project(const struct camera *camera, ps_vec3 point, float *x, float *y)
{
    ps_vec3 away = ps_subtract(point, camera->location);
    float depth = ps_dot(away, camera->forward);
    if (!(depth > 0.0f))
        return false;
    if (!camera->orthographic)
        away = ps_scale(away, 1.0f / depth);
    ps_vec3 inside = ps_subtract(away, camera->corner);
    *x = ps_dot(inside, camera->across) / ps_dot(camera->across, camera->across);
    *y = ps_dot(inside, camera->down) / ps_dot(camera->down, camera->down);
    return true;
}

float camera_pixel_spread(const struct camera *camera, ps_vec3 direction)
{
    if (camera->orthographic)
        return 0.0f;
    return ps_length(camera->across) * ps_dot(direction, camera->forward);
}

float camera_pixel_size(const struct camera *camera, ps_vec3 point)
{
    float side = ps_length(camera->across);
    float depth = ps_dot(ps_subtract(point, camera->location), camera->forward);
    if (!(depth > 0.0f))
        return 0.0f;
    return camera->orthographic ? side : side * depth;
}
