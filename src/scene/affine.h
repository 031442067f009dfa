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

/* The signed factor on volumes: 0 where the map is flat, below 0 where it mirrors. A double,
 * because the cube of a small scale is no float. */
static inline double affine_determinant(const struct affine *map)
{
    const ps_vec3 *x = &map->x, *y = &map->y, *z = &map->z;
    return x->x * ((double)y->y * z->z - (double)y->z * z->y) +
           x->y * ((double)y->z * z->x - (double)y->x * z->z) +
           x->z * ((double)y->x * z->y - (double)y->y * z->x);
}

/* The binary logarithm of the mean factor on lengths; -INFINITY where the map is flat. */
static inline float affine_log_scale(const struct affine *map)
{
    return (float)(log2(fabs(affine_determinant(map))) / 3.0);
}

/* A normal's image, times the determinant: the cofactor matrix, which needs no inverse. It lies on
 * the side that the image of a triangle's winding gives; where the map mirrors, that is the image
 * of the other side. Not of length 1. */
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

/* Applied in this order: scale, rotate about x, then y, then z (degrees, right-handed),
 * translate. */
struct affine affine_of(ps_vec3 scale, ps_vec3 rotate, ps_vec3 translate);

/* False where the map has no inverse. */
bool affine_invert(const struct affine *map, struct affine *inverse);

/* Whether the map is one of rotations, translations, mirrors and a scale by equal factors, to
 * within the rounding of some such maps in a row: 1e-5 of that factor. False where it is flat. */
bool affine_is_similarity(const struct affine *map);

#endif
