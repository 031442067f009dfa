#include "scene/camera.h"

#include <psplat/math.h>

static double half_tangent(double degrees)
{
    return tan(degrees * (3.14159265358979323846 / 360.0));
}

struct camera camera_from_description(const struct camera_description *description, size_t width,
                                      size_t height)
{
    double aspect = (double)width / (double)height;
    double half_width = description->vertical_angle > 0
                            ? half_tangent(description->vertical_angle) * aspect
                            : half_tangent(description->angle);
    double half_height = half_width / aspect;
    ps_vec3 forward = ps_normalize(ps_subtract(description->look_at, description->location));
    ps_vec3 right = ps_normalize(ps_cross(forward, description->up));
    ps_vec3 up = ps_cross(right, forward);
    struct camera camera = {
        .location = description->location,
        .across = ps_scale(right, (float)(2.0 * half_width / (double)width)),
        .down = ps_scale(up, (float)(-2.0 * half_height / (double)height)),
    };
    camera.corner = ps_add_scaled(forward, (float)-half_width, right);
    camera.corner = ps_add_scaled(camera.corner, (float)half_height, up);
    return camera;
}

ps_ray camera_ray(const struct camera *camera, float x, float y)
{
    ps_vec3 direction = ps_add_scaled(camera->corner, x, camera->across);
    direction = ps_add_scaled(direction, y, camera->down);
    return (ps_ray){camera->location, 0.0f, ps_normalize(direction), INFINITY};
}
