/* shape.h: turns a described object into a shape in the space of its file or group: triangles, or a
 * sphere.
 *
 * The front of a closed shape is its outside, also where its placement mirrors it. The front of an
 * open one is the placement's image of its front: a mirrored light shines as its mirror image
 * would. The front of a quad or a triangle is the side that sees its corners counter-clockwise
 * before it is placed; of a disc and a plane the one that the normal points to; of a height field
 * +y.
 *
 * (u, v) of a picture on a shape, u to the right and v upwards as seen from the front:
 *   quad             (0, 0), (1, 0), (1, 1), (0, 1) at corners 0 to 3
 *   box              0..1 on every face; v is y on the sides, -z on top, z below; u on top is x
 *   sphere           u round y, counter-clockwise from -x as seen from +y; v from 0 at -y to 1 at
 *                    +y, even in angle
 *   cylinder, cone   u round the axis from points[0] to [1] as round a sphere's y; v along it
 *   torus            u as a sphere; v round the tube: inside 0, below 1/4, outside 1/2, top 3/4
 *   disc, and ends   0..1 over the square around it, along the frame (ps_frame) of its normal
 *   plane            lengths in the object's own units along the frame of its normal, from the
 *                    point of the plane next to the origin: a picture repeats over every unit
 *   height field     (x, z): mirrored as seen from above, as POV-Ray's axes are left-handed
 *   mesh             its own
 *   triangles        none
 * Where the placement mirrors, the picture is mirrored with the shape. The frame of +y is x, -z; of
 * +z it is x, y.
 *
 * Round shapes other than an exact sphere are meshes whose vertices lie on the true surface. With
 * 64 segments their area is too small by this share: disc 0.16 %, side of a cylinder 0.04 %, torus
 * of radii 2 and 0.5 0.26 %; sphere as an ellipsoid, which is finer, 0.05 %. It falls with the
 * square of the segments.
 */
#ifndef SCENE_SHAPE_H
#define SCENE_SHAPE_H

#include "base/error.h"
#include "scene/box.h"
#include "scene/description.h"

/* Of round meshes: how many segments around are allowed, and the number where none is stated. A
 * torus has half as many around its tube. */
#define SHAPE_SEGMENTS_MIN 3
#define SHAPE_SEGMENTS_MAX 8192
#define SHAPE_SEGMENTS_DEFAULT 64

/* Of a height field: the most samples its picture may have. */
#define SHAPE_HEIGHT_SAMPLES_MAX ((size_t)1 << 27)

enum shape_kind { SHAPE_MESH, SHAPE_SPHERE };

struct shape {
    enum shape_kind kind;
    uint32_t material;
    bool hidden;       /* from the camera */
    bool front_only;   /* that is, from behind */
    ps_vec3 *vertices; /* mesh; counter-clockwise triangles seen from the front; room for one more
                              follows, since the ray tracer loads 16 bytes at each */
    ps_vec3 *normals;  /* mesh: unit, of each vertex in use, on the front; NULL: flat */
    float (*uv)[2];    /* mesh: of each vertex; NULL: none */
    float (*second_uv)[2]; /* mesh file: likewise */
    float (*colors)[4];    /* mesh file: linear colour and alpha of each vertex; NULL: none */
    size_t vertex_count;
    uint32_t (*triangles)[3]; /* mesh: none without an area */
    size_t triangle_count;    /* may be 0 for triangles and meshes, else at least 1 */
    size_t dropped;           /* mesh: triangles left out because they have no area */
    struct box box;           /* around the triangles, or the sphere */
    ps_vec3 center;           /* sphere */
    float radius;             /* sphere */
    ps_vec3 axes[3]; /* sphere: unit; where its own x, y, z point: u goes round axes[1]. Left-handed
                        where the placement mirrors. */
};

/* Brightness in rows from top to bottom, which is from z = 1 to z = 0; each row from x = 0 to x =
 * 1. */
struct height_samples {
    size_t width, height; /* at least 2 */
    const float *samples; /* the height at y: 0..1, or more for an HDR picture */
};

/* What a shape takes from around its object; borrowed for the call. */
struct shape_surroundings {
    ps_vec3 center; /* plane without an extent: bounding sphere of the other shapes, in the space */
    float radius;   /* where the shape will be; 0: there are none */
    /* Plane without a distance: around the other objects, there; NULL: none. */
    const struct box *box;
    const struct mesh_description *meshes; /* objects' `mesh` are indices into it */
    const struct height_samples *heights;  /* height field: of the object's texture */
};

/* Makes a shape of one object, not an instance. PS_ERROR_INVALID where the object has no such shape
 * (sizes, a placement that flattens it, overflow of its coordinates), with the object's origin in
 * the message; PS_ERROR_MEMORY. Nothing is left to release after an error. Threads: any. */
ps_result shape_create(const struct object_description *object,
                       const struct shape_surroundings *surroundings, struct shape *shape,
                       struct error *error);
void shape_release(struct shape *shape);

/* A point of a mesh's triangle: its corners, and the point's shares of them, whose sum is 1. */
struct shape_point {
    const uint32_t *corners;
    float shares[3];
};

/* (u, v) there by shape->uv, or shape->second_uv; 0 for NULL. */
void shape_mesh_uv(const float (*uv)[2], const struct shape_point *point, float at[2]);

/* Linear colour and alpha of the vertices; white where there are none. */
void shape_mesh_color(const struct shape *shape, const struct shape_point *point, float rgba[4]);

/* (u, v), both in 0..1, where a SHAPE_SPHERE has the unit outward normal `outward`. */
void shape_sphere_uv(const struct shape *shape, ps_vec3 outward, float uv[2]);

/* The position's derivatives by u and v there, in scene units. At the poles, where every direction
 * is one of u, they are those of a point next to them, so that neither is zero. */
void shape_sphere_tangents(const struct shape *shape, ps_vec3 outward, ps_vec3 *along_u,
                           ps_vec3 *along_v);

#endif
