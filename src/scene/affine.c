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

/* a x b / divisor */
static ps_vec3 divided_cross(ps_vec3 a, ps_vec3 b, double divisor)
{
    return (ps_vec3){
        (float)(((double)a.y * b.z - (double)a.z * b.y) / divisor),
        (float)(((double)a.z * b.x - (double)a.x * b.z) / divisor),
        (float)(((double)a.x * b.y - (double)a.y * b.x) / divisor),
    };
}

bool affine_invert(const struct affine *map, struct affine *inverse)
{
    double determinant = affine_determinant(map);
    if (!(fabs(determinant) > 0.0) || !isfinite(determinant))
        return false;
    ps_vec3 a = divided_cross(map->y, map->z, determinant);
    ps_vec3 b = divided_cross(map->z, map->x, determinant);
    ps_vec3 c = divided_cross(map->x, map->y, determinant);
    *inverse =
        (struct affine){{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {0.0f, 0.0f, 0.0f}};
    inverse->translation = ps_scale(affine_direction(inverse, map->translation), -1.0f);
    return true;
}

static double dot(ps_vec3 a, ps_vec3 b)
{
    return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z;
}

bool affine_is_similarity(const struct affine *map)
{
    double square = dot(map->x, map->x);
    double tolerance = 1e-5 * square;
    return square > 0.0 && fabs(dot(map->y, map->y) - square) <= 2.0 * tolerance &&
           fabs(dot(map->z, map->z) - square) <= 2.0 * tolerance &&
           fabs(dot(map->x, map->y)) <= tolerance && fabs(dot(map->y, map->z)) <= tolerance &&
           fabs(dot(map->z, map->x)) <= tolerance;
}
