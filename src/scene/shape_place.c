/* shape_place.c: carries a mesh from its object's own space to where it stands.
 *
 * Points go through the placement, normals through its cofactors (the inverse transpose times the
 * determinant, which needs no division). Cofactors and winding both turn to the other side where
 * the placement mirrors; there both are turned back, so that the front stays the image of the
 * front.
 *
 * Triangles without an area go: nothing can hit them, and a choice of points by area would divide
 * by 0. Normals that are missing (zero, not a number) become the mean of the faces around the
 * vertex, weighted by the angle of each there, which does not depend on how the faces are cut
 * (Thuermer and Wuethrich 1998).
 */
#include "scene/shape_build.h"

#include "scene/vector.h"
#include <stdlib.h>

static struct vector edge(const struct shape *shape, uint32_t from, uint32_t to)
{
    ps_vec3 a = shape->vertices[from], b = shape->vertices[to];
    return (struct vector){(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
}

/* Twice the area along the normal; exact enough in double precision to be 0 for corners on a
 * line. */
static struct vector area_vector(const struct shape *shape, const uint32_t corners[3])
{
    return vector_cross(edge(shape, corners[0], corners[1]), edge(shape, corners[0], corners[2]));
}

static double corner_angle(const struct shape *shape, const uint32_t corners[3], int k)
{
    uint32_t here = corners[k];
    struct vector a = edge(shape, here, corners[(k + 1) % 3]);
    struct vector b = edge(shape, here, corners[(k + 2) % 3]);
    return atan2(vector_length(vector_cross(a, b)), vector_dot(a, b));
}

static ps_result place_vertices(const struct object_description *object, struct shape *shape,
                                struct error *error)
{
    for (size_t i = 0; i < shape->vertex_count; i++) {
        ps_vec3 *p = &shape->vertices[i];
        *p = affine_point(&object->placement, *p);
        if (!isfinite(p->x) || !isfinite(p->y) || !isfinite(p->z))
            return shape_invalid(object, error, "a corner is no number or out of range");
    }
    return PS_OK;
}

static float largest_of(ps_vec3 v)
{
    return fmaxf(fabsf(v.x), fmaxf(fabsf(v.y), fabsf(v.z)));
}

/* The placement without its size and place, whose cofactors are in range. */
static struct affine shrunk(const struct affine *map)
{
    float largest = fmaxf(largest_of(map->x), fmaxf(largest_of(map->y), largest_of(map->z)));
    return (struct affine){ps_scale(map->x, 1.0f / largest),
                           ps_scale(map->y, 1.0f / largest),
                           ps_scale(map->z, 1.0f / largest),
                           {0, 0, 0}};
}

static void place_normals(const struct affine *placement, bool mirrors, struct shape *shape)
{
    struct affine map = shrunk(placement);
    for (size_t i = 0; shape->normals && i < shape->vertex_count; i++) {
        ps_vec3 n = affine_normal(&map, unit_or_zero(shape->normals[i]));
        shape->normals[i] = unit_or_zero(ps_scale(n, mirrors ? -1.0f : 1.0f));
    }
}

static void turn_triangles(struct shape *shape)
{
    for (size_t i = 0; i < shape->triangle_count; i++) {
        uint32_t *corners = shape->triangles[i], second = corners[1];
        corners[1] = corners[2];
        corners[2] = second;
    }
}

static void drop_flat_triangles(struct shape *shape)
{
    size_t kept = 0;
    for (size_t i = 0; i < shape->triangle_count; i++) {
        if (!(vector_length(area_vector(shape, shape->triangles[i])) > 0.0))
            continue;
        for (int k = 0; k < 3; k++)
            shape->triangles[kept][k] = shape->triangles[i][k];
        kept++;
    }
    shape->dropped = shape->triangle_count - kept;
    shape->triangle_count = kept;
}

static bool is_missing(ps_vec3 normal)
{
    return normal.x == 0.0f && normal.y == 0.0f && normal.z == 0.0f;
}

static ps_vec3 face_normal(const struct shape *shape, const uint32_t corners[3])
{
    struct vector area = area_vector(shape, corners);
    double size = vector_length(area);
    return (ps_vec3){(float)(area.x / size), (float)(area.y / size), (float)(area.z / size)};
}

/* Adds each face's normal to those of its corners that are missing. */
static void add_face_normals(const bool *missing, struct shape *shape)
{
    for (size_t i = 0; i < shape->triangle_count; i++) {
        const uint32_t *corners = shape->triangles[i];
        for (int k = 0; k < 3; k++) {
            if (!missing[corners[k]])
                continue;
            ps_vec3 *sum = &shape->normals[corners[k]];
            float angle = (float)corner_angle(shape, corners, k);
            *sum = ps_add_scaled(*sum, angle, face_normal(shape, corners));
        }
    }
}

/* Where faces cancel each other, one of them has to do. */
static void settle_normals(const bool *missing, struct shape *shape)
{
    for (size_t i = 0; i < shape->vertex_count; i++)
        if (missing[i])
            shape->normals[i] = unit_or_zero(shape->normals[i]);
    for (size_t i = 0; i < shape->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            ps_vec3 *normal = &shape->normals[shape->triangles[i][k]];
            if (is_missing(*normal))
                *normal = face_normal(shape, shape->triangles[i]);
        }
}

static ps_result fill_missing_normals(struct shape *shape, struct error *error)
{
    if (!shape->normals || shape->vertex_count == 0)
        return PS_OK;
    bool *missing = malloc(shape->vertex_count * sizeof *missing);
    if (!missing)
        return error_memory(error, shape->vertex_count * sizeof *missing, "a mesh's normals");
    bool any = false;
    for (size_t i = 0; i < shape->vertex_count; i++) {
        missing[i] = is_missing(shape->normals[i]);
        any = any || missing[i];
    }
    if (any) {
        add_face_normals(missing, shape);
        settle_normals(missing, shape);
    }
    free(missing);
    return PS_OK;
}

ps_result shape_place(const struct object_description *object, struct shape *shape,
                      struct error *error)
{
    bool mirrors = affine_determinant(&object->placement) < 0.0;
    ps_result result = place_vertices(object, shape, error);
    if (result != PS_OK)
        return result;
    place_normals(&object->placement, mirrors, shape);
    if (mirrors)
        turn_triangles(shape);
    drop_flat_triangles(shape);
    return fill_missing_normals(shape, error);
}
