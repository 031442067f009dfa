/* vector.h: vectors in double precision, where differences of coordinates must not lose what they
 * tell. */
#ifndef SCENE_VECTOR_H
#define SCENE_VECTOR_H

#include <math.h>
#include <psplat/types.h>

struct vector {
    double x, y, z;
};

static inline struct vector vector_of(ps_vec3 v)
{
    return (struct vector){v.x, v.y, v.z};
}

static inline struct vector vector_subtract(struct vector a, struct vector b)
{
    return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vector vector_add(struct vector a, struct vector b)
{
    return (struct vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vector vector_scale(struct vector v, double factor)
{
    return (struct vector){v.x * factor, v.y * factor, v.z * factor};
}

static inline double vector_dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vector vector_cross(struct vector a, struct vector b)
{
    return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double vector_length(struct vector v)
{
    return sqrt(vector_dot(v, v));
}

/* Of length 1; of length 0, as it is. */
static inline struct vector vector_unit(struct vector v)
{
    double length = vector_length(v);
    return length > 0.0 ? (struct vector){v.x / length, v.y / length, v.z / length} : v;
}

#endif
