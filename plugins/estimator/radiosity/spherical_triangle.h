/* spherical_triangle.h: directions even over the solid angle of a triangle.
 *
 * Arvo 1995, Stratified sampling of spherical triangles: an area of the triangle is cut off by an
 * arc through one corner, and a point of that arc chosen. Unlike points that are even over the
 * triangle itself, directions have no density without bounds where the triangle begins at the eye's
 * own surface.
 */
#ifndef PSPLAT_ESTIMATOR_RADIOSITY_SPHERICAL_TRIANGLE_H
#define PSPLAT_ESTIMATOR_RADIOSITY_SPHERICAL_TRIANGLE_H

#include <psplat/math.h>

/* As seen from the origin. */
struct spherical_triangle {
    ps_vec3 corners[3]; /* unit directions */
    float alpha;        /* the angle at the first corner */
    float solid_angle;
};

/* Of corners seen from the origin; the solid angle is 0 where they lie in line with it. */
struct spherical_triangle spherical_triangle(const ps_vec3 corners[3]);

/* From two numbers of [0, 1); the solid angle must not be 0. */
ps_vec3 spherical_triangle_sample(const struct spherical_triangle *triangle,
                                  const float numbers[2]);

#endif
