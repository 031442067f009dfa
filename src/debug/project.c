#include "debug/project.h"

#include <psplat/math.h>

bool project_visible(const struct render *render, ps_vec3 position, ps_vec3 away, float *x,
                     float *y)
{
    static const float pinhole[2] = {0, 0};
    const struct scene *scene = render->scene;
    ps_vec3 point = ps_add_scaled(position, scene->surface_offset, away);
    if (!camera_project(&scene->camera, point, x, y))
        return false;
    if (!(*x >= 0.0f && *y >= 0.0f && *x < (float)scene->width && *y < (float)scene->height))
        return false;
    ps_ray ray = camera_ray(&scene->camera, *x, *y, pinhole);
    ray.tfar = ps_dot(ps_subtract(point, ray.origin), ray.direction);
    uint8_t blocked;
    trace_occluded(render->trace, &ray, 1, &blocked);
    return !blocked;
}
