/* affine.h: affine maps: how an object's own space lies in another.
 *
 * A point p goes to p.x * x + p.y * y + p.z * z + translation.
 */
#ifndef SCENE_AFFINE_H
#define SCENE_AFFINE_H

#include <psplat/math.h>
#include <stdbool.h>

struct affine {
    ps_vec3 x, y, z; /* where the axes go: the columns of the linear part */
    ps_vec3 translation;
};

#define AFFINE_IDENTITY                                                                            \
    {                                                                                              \
        {1, 0, 0}, {0, 1, 0}, {0, 0, 1},                                                           \
        {                                                                                          \
            0, 0, 0                                                                                \
        }                                                                                          \
    }

static inline ps_vec3 affine_direction(const struct affine *map, ps_vec3 d)
{
    ps_vec3 sum = ps_scale(map->x, d.x);
    return ps_add_scaled(ps_add_scaled(sum, d.y, map->y), d.z, map->z);
}

static inline ps_vec3 affine_point(const struct affine *map, ps_vec3 p)
{
    return ps_add(affine_direction(map, p), map->translation);
}

/* The signed factor on volumes; 0 where the map is flat. */
static inline float affine_determinant(const struct affine *map)
{
    return ps_dot(map->x, ps_cross(map->y, map->z));
}

/* A normal's image, times the determinant's size: the cofactor matrix, which needs no inverse and
 * keeps the side that a triangle's winding gives. Not of length 1. */
static inline ps_vec3 affine_normal(const struct affine *map, ps_vec3 n)
{
    ps_vec3 sum = ps_scale(ps_cross(map->y, map->z), n.x);
    sum = ps_add_scaled(sum, n.y, ps_cross(map->z, map->x));
    return ps_add_scaled(sum, n.z, ps_cross(map->x, map->y));
}

/* First `inner`, then `outer`. */
static inline struct affine affine_compose(const struct affine *outer, const struct affine *inner)
{
    return (struct affine){
        affine_direction(outer, inner->x),
        affine_direction(outer, inner->y),
        affine_direction(outer, inner->z),
        affine_point(outer, inner->translation),
    };
}

/* Applied in this order: scale, rotate about x, then y, then z (degrees, right-handed), translate. */
struct affine affine_of(ps_vec3 scale, ps_vec3 rotate, ps_vec3 translate);

/* False where the map has no inverse. */
static inline bool affine_invert(const struct affine *map, struct affine *inverse)
{
    float determinant = affine_determinant(map);
    if (!(fabsf(determinant) > 0.0f) || !isfinite(determinant))
        return false;
    ps_vec3 a = ps_scale(ps_cross(map->y, map->z), 1.0f / determinant);
    ps_vec3 b = ps_scale(ps_cross(map->z, map->x), 1.0f / determinant);
    ps_vec3 c = ps_scale(ps_cross(map->x, map->y), 1.0f / determinant);
    *inverse =
        (struct affine){{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {0.0f, 0.0f, 0.0f}};
    inverse->translation = ps_scale(affine_direction(inverse, map->translation), -1.0f);
    return true;
}

#endif
