#include "scene/shape.h"

#include <psplat/math.h>
#include <stdlib.h>

static const uint32_t quad_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};

/* Corner i of a box has x, y, z of the high corner where bits 0, 1, 2 of i are set. */
static const uint32_t box_triangles[12][3] = {
    {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
};

static ps_result allocate_mesh(struct shape *shape, size_t vertices, size_t triangles,
                               struct error *error)
{
    size_t vertex_bytes = vertices * sizeof *shape->vertices;
    size_t triangle_bytes = triangles * sizeof *shape->triangles;
    shape->kind = SHAPE_MESH;
    shape->vertices = malloc(vertex_bytes ? vertex_bytes : 1);
    shape->triangles = malloc(triangle_bytes ? triangle_bytes : 1);
    shape->vertex_count = vertices;
    shape->triangle_count = triangles;
    if (shape->vertices && shape->triangles)
        return PS_OK;
    shape_release(shape);
    return error_memory(error, vertex_bytes + triangle_bytes, "a mesh");
}

static void copy_triangles(struct shape *shape, const uint32_t (*triangles)[3])
{
    for (size_t i = 0; i < shape->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            shape->triangles[i][k] = triangles[i][k];
}

static ps_result create_box(const struct object_description *object, struct shape *shape,
                            struct error *error)
{
    ps_result result = allocate_mesh(shape, 8, 12, error);
    if (result != PS_OK)
        return result;
    for (unsigned i = 0; i < 8; i++) {
        const ps_vec3 *corner = object->vertices;
        ps_vec3 p = {corner[i & 1].x, corner[i >> 1 & 1].y, corner[i >> 2].z};
        shape->vertices[i] = affine_point(&object->placement, p);
    }
    copy_triangles(shape, box_triangles);
    return PS_OK;
}

static ps_result create_mesh(const struct object_description *object,
                             const uint32_t (*triangles)[3], size_t triangle_count,
                             struct shape *shape, struct error *error)
{
    ps_result result = allocate_mesh(shape, object->vertex_count, triangle_count, error);
    if (result != PS_OK)
        return result;
    for (size_t i = 0; i < object->vertex_count; i++)
        shape->vertices[i] = affine_point(&object->placement, object->vertices[i]);
    copy_triangles(shape, triangles);
    return PS_OK;
}

ps_result shape_create(const struct object_description *object, struct shape *shape,
                       struct error *error)
{
    *shape = (struct shape){.material = (uint32_t)object->material};
    switch (object->kind) {
    case OBJECT_QUAD:
        return create_mesh(object, quad_triangles, 2, shape, error);
    case OBJECT_BOX:
        return create_box(object, shape, error);
    case OBJECT_TRIANGLES:
        return create_mesh(object, (const uint32_t(*)[3])object->triangles, object->triangle_count,
                           shape, error);
    case OBJECT_SPHERE:
        shape->kind = SHAPE_SPHERE;
        shape->center = affine_point(&object->placement, object->center);
        shape->radius = (float)object->radius * ps_length(object->placement.x);
        return PS_OK;
    default:
        return error_set(error, PS_ERROR_INVALID, "object of unknown kind %d", (int)object->kind);
    }
}

void shape_release(struct shape *shape)
{
    free(shape->vertices);
    free(shape->triangles);
    free(shape->normals);
    free(shape->uv);
    *shape = (struct shape){.kind = SHAPE_MESH};
}

static void extend(ps_vec3 p, ps_vec3 *low, ps_vec3 *high)
{
    *low = (ps_vec3){fminf(low->x, p.x), fminf(low->y, p.y), fminf(low->z, p.z)};
    *high = (ps_vec3){fmaxf(high->x, p.x), fmaxf(high->y, p.y), fmaxf(high->z, p.z)};
}

void shape_extend_bounds(const struct shape *shape, ps_vec3 *low, ps_vec3 *high)
{
    if (shape->kind == SHAPE_SPHERE) {
        ps_vec3 extent = {shape->radius, shape->radius, shape->radius};
        extend(ps_subtract(shape->center, extent), low, high);
        extend(ps_add(shape->center, extent), low, high);
    }
    for (size_t i = 0; i < shape->vertex_count; i++)
        extend(shape->vertices[i], low, high);
}
