/* shape_build.h: what the files that build shapes share; shape.h is for everyone else.
 *
 * A mesh is built in the object's own space, front and normals included, and then placed. So a
 * shape states its winding once, and the questions that a placement asks (mirrors, normals,
 * triangles that collapse) have one answer for all of them, in shape_place.c.
 */
#ifndef SCENE_SHAPE_BUILD_H
#define SCENE_SHAPE_BUILD_H

#include "scene/shape.h"
#include <float.h>
#include <psplat/math.h>

typedef ps_result shape_builder(const struct object_description *object,
                                const struct shape_surroundings *surroundings, struct shape *shape,
                                struct error *error);

/* PS_ERROR_INVALID where an object's numbers, taken together, make no shape: single ones were
 * bounded as they were read. Meshes are placed by the caller, which also releases the shape after
 * an error. */
shape_builder shape_quad, shape_box, shape_triangles, shape_mesh;  /* shape_flat.c */
shape_builder shape_plane;                                         /* shape_plane.c */
shape_builder shape_cylinder, shape_cone, shape_disc, shape_torus; /* shape_round.c */
shape_builder shape_sphere;                                        /* shape_sphere.c */
shape_builder shape_height_field;                                  /* shape_height_field.c */

/* PS_ERROR_INVALID, with the message behind the object's kind. */
ps_result shape_invalid(const struct object_description *object, struct error *error,
                        const char *message);

enum mesh_parts { MESH_NORMALS = 1, MESH_UV = 2, MESH_SECOND_UV = 4, MESH_COLORS = 8 };

/* Zeroed arrays; `parts` is a sum of enum mesh_parts. */
ps_result shape_allocate(struct shape *shape, size_t vertices, size_t triangles, unsigned parts,
                         struct error *error);

/* Carries a mesh from the object's space through its placement. */
ps_result shape_place(const struct object_description *object, struct shape *shape,
                      struct error *error);

/* Two triangles of four vertices in order around, the first of which is `first`. */
static inline void set_square(uint32_t (*triangles)[3], uint32_t first)
{
    for (uint32_t i = 0; i < 2; i++) {
        triangles[i][0] = first;
        triangles[i][1] = first + 1 + i;
        triangles[i][2] = first + 2 + i;
    }
}

/* Segments around, the default in place of 0. */
static inline size_t shape_segments(const struct object_description *object)
{
    return object->segments ? (size_t)object->segments : SHAPE_SEGMENTS_DEFAULT;
}

/* Zero where v has no direction: no length, or not finite. Its square may be out of range. */
static inline ps_vec3 unit_or_zero(ps_vec3 v)
{
    float largest = fmaxf(fabsf(v.x), fmaxf(fabsf(v.y), fabsf(v.z)));
    if (!(largest > 0.0f) || !isfinite(v.x) || !isfinite(v.y) || !isfinite(v.z))
        return (ps_vec3){0.0f, 0.0f, 0.0f};
    return ps_normalize((ps_vec3){v.x / largest, v.y / largest, v.z / largest});
}

/* A length above 0 that single precision can hold. */
static inline bool is_length(double value)
{
    return value >= (double)FLT_MIN && value <= (double)FLT_MAX;
}

static inline bool is_length_or_zero(double value)
{
    return value == 0.0 || is_length(value);
}

static inline bool has_direction(ps_vec3 v)
{
    return ps_length(unit_or_zero(v)) > 0.0f;
}

/* Unit vectors that complete unit vector n to a right-handed frame. -0 counts as 0, which ps_frame
 * tells apart. */
static inline void shape_frame(ps_vec3 n, ps_vec3 *u, ps_vec3 *v)
{
    ps_frame((ps_vec3){n.x + 0.0f, n.y + 0.0f, n.z + 0.0f}, u, v);
}

#endif
