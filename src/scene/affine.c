#include "scene/affine.h"

static ps_vec3 rotate_about(ps_vec3 p, int axis, float degrees)
{
    float c = cosf(degrees * PS_PI / 180.0f), s = sinf(degrees * PS_PI / 180.0f);
    switch (axis) {
    case 0:
        return (ps_vec3){p.x, c * p.y - s * p.z, s * p.y + c * p.z};
    case 1:
        return (ps_vec3){c * p.x + s * p.z, p.y, c * p.z - s * p.x};
    default:
        return (ps_vec3){c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    }
}

static ps_vec3 rotate_about_all(ps_vec3 p, ps_vec3 degrees)
{
    p = rotate_about(p, 0, degrees.x);
    p = rotate_about(p, 1, degrees.y);
    return rotate_about(p, 2, degrees.z);
}

struct affine affine_of(ps_vec3 scale, ps_vec3 rotate, ps_vec3 translate)
{
    return (struct affine){
        rotate_about_all((ps_vec3){scale.x, 0, 0}, rotate),
        rotate_about_all((ps_vec3){0, scale.y, 0}, rotate),
        rotate_about_all((ps_vec3){0, 0, scale.z}, rotate),
        translate,
    };
}
