/* transform.h: the transforms of imported scenes: 4x4 matrices in doubles, of which the last row is
 * 0 0 0 1.
 *
 * A column vector is multiplied from the right, p' = M p; pbrt's text lists matrices by columns
 * (pbrt-v4 file format, "Transformations"). Angles are in degrees. Scenes chain many transforms, so
 * doubles.
 */
#ifndef WRITER_TRANSFORM_H
#define WRITER_TRANSFORM_H

#include "scene/vector.h"
#include <stdbool.h>

struct transform {
    double m[3][4]; /* rows */
};

extern const struct transform transform_identity;

/* First `inner`, then `outer`. */
struct transform transform_compose(const struct transform *outer, const struct transform *inner);
struct transform transform_translate(double x, double y, double z);
struct transform transform_scale(double x, double y, double z);

/* Counter-clockwise about the axis by the right-hand rule of its coordinates. False where the axis
 * is 0. */
bool transform_rotate(double degrees, struct vector axis, struct transform *result);

/* World to camera: the eye goes to the origin, `look` onto the positive z axis, `up` leans to y,
 * and x is up cross direction (pbrt, LookAt). False where the points are one or `up` lies along the
 * view. */
bool transform_look_at(struct vector eye, struct vector look, struct vector up,
                       struct transform *result);

/* From pbrt's 16 numbers. False where the last row is not a multiple of 0 0 0 1. */
bool transform_from_columns(const double numbers[16], struct transform *result);

/* Of the linear part. */
double transform_determinant(const struct transform *map);
/* False where there is none. */
bool transform_invert(const struct transform *map, struct transform *inverse);

struct vector transform_point(const struct transform *map, struct vector p);
struct vector transform_direction(const struct transform *map, struct vector d);
/* On the side that the image of the normal's side is on, also where the map mirrors; not of length
 * 1. */
struct vector transform_normal(const struct transform *map, struct vector n);

#endif
