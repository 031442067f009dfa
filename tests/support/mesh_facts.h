/* mesh_facts.h: what holds of a shape's mesh as a whole. Failures end the cmocka test. */
#ifndef TESTS_SUPPORT_MESH_FACTS_H
#define TESTS_SUPPORT_MESH_FACTS_H

#include "scene/shape.h"

/* The shape of an object, which must have one; a zero placement counts as the identity, NULL
 * surroundings as none. */
struct shape shape_of(struct object_description object,
                      const struct shape_surroundings *surroundings);

/* That it has none, with PS_ERROR_INVALID and this in the message, and nothing to release. */
void expect_no_shape(struct object_description object,
                     const struct shape_surroundings *surroundings, const char *message);

double mesh_area(const struct shape *shape);

/* Above 0 where a closed mesh faces out (divergence theorem). */
double mesh_volume(const struct shape *shape);

/* Of the triangles' normals times their areas: 0 for a closed mesh. */
void mesh_area_vector(const struct shape *shape, double sum[3]);

/* Whether each edge is shared by two triangles that pass it in opposite directions. Vertices in one
 * place count as one. */
bool mesh_is_closed(const struct shape *shape);

/* Normals are unit, and within 90 degrees of the faces that use them. */
void expect_good_normals(const struct shape *shape);

/* (u, v) lie in 0..1, and turn on every triangle as `sign` says: 1: u to the right and v upwards
 * seen from the front; -1: mirrored. */
void expect_good_uv(const struct shape *shape, int sign);

void expect_near(double value, double expected, double relative);
void expect_vector(ps_vec3 p, double x, double y, double z);

#endif
