#include "scene/shape.h"

#include "scene/shape_build.h"
#include <stdlib.h>

static const struct {
    const char *name;
    shape_builder *build;
} kinds[] = {
    [OBJECT_QUAD] = {"quad", shape_quad},
    [OBJECT_BOX] = {"box", shape_box},
    [OBJECT_TRIANGLES] = {"triangles", shape_triangles},
    [OBJECT_SPHERE] = {"sphere", shape_sphere},
    [OBJECT_CYLINDER] = {"cylinder", shape_cylinder},
    [OBJECT_CONE] = {"cone", shape_cone},
    [OBJECT_DISC] = {"disc", shape_disc},
    [OBJECT_PLANE] = {"plane", shape_plane},
    [OBJECT_TORUS] = {"torus", shape_torus},
    [OBJECT_HEIGHT_FIELD] = {"height_field", shape_height_field},
    [OBJECT_MESH] = {"mesh", shape_mesh},
};

static bool is_shape(const struct object_description *object)
{
    return (size_t)object->kind < sizeof kinds / sizeof kinds[0];
}

ps_result shape_invalid(const struct object_description *object, struct error *error,
                        const char *message)
{
    return error_set(error, PS_ERROR_INVALID, "%s: %s",
                     is_shape(object) ? kinds[object->kind].name : "object", message);
}

/* Lists of triangles may come empty, or be of nothing but slivers; a shape with a name may not. */
static bool may_be_empty(const struct object_description *object)
{
    return object->kind == OBJECT_TRIANGLES || object->kind == OBJECT_MESH;
}

/* By triangles: a list may hold vertices that none of them uses. */
static struct box box_of(const struct shape *shape)
{
    struct box box = BOX_EMPTY;
    if (shape->kind == SHAPE_SPHERE) {
        ps_vec3 extent = {shape->radius, shape->radius, shape->radius};
        box_add_point(&box, ps_subtract(shape->center, extent));
        box_add_point(&box, ps_add(shape->center, extent));
    }
    for (size_t i = 0; i < shape->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            box_add_point(&box, shape->vertices[shape->triangles[i][k]]);
    return box;
}

static ps_result create(const struct object_description *object,
                        const struct shape_surroundings *surroundings, struct shape *shape,
                        struct error *error)
{
    double determinant = affine_determinant(&object->placement);
    if (!is_shape(object))
        return shape_invalid(object, error,
                             object->kind == OBJECT_INSTANCE
                                 ? "an instance of a group is no shape by itself"
                                 : "unknown kind of object");
    if (!(fabs(determinant) > 0.0 && isfinite(determinant)))
        return shape_invalid(object, error, "its placement makes it flat, or is out of range");
    ps_result result = kinds[object->kind].build(object, surroundings, shape, error);
    if (result != PS_OK || shape->kind != SHAPE_MESH)
        return result;
    result = shape_place(object, shape, error);
    if (result == PS_OK && shape->triangle_count == 0 && !may_be_empty(object))
        return shape_invalid(object, error, "it has no area");
    return result;
}

ps_result shape_create(const struct object_description *object,
                       const struct shape_surroundings *surroundings, struct shape *shape,
                       struct error *error)
{
    *shape = (struct shape){.material = (uint32_t)object->material,
                            .hidden = object->hidden,
                            .front_only = object->front_only};
    ps_result result = create(object, surroundings, shape, error);
    if (result == PS_OK)
        shape->box = box_of(shape);
    else
        shape_release(shape);
    return result;
}

/* Never NULL for want of a size. */
static void *allocate_array(size_t count, size_t size)
{
    return calloc(count ? count : 1, size);
}

ps_result shape_allocate(struct shape *shape, size_t vertices, size_t triangles, unsigned parts,
                         struct error *error)
{
    shape->kind = SHAPE_MESH;
    if (vertices > UINT32_MAX || triangles > UINT32_MAX)
        return error_set(error, PS_ERROR_INVALID,
                         "a mesh of %zu vertices and %zu triangles is more than can be traced",
                         vertices, triangles);
    shape->vertices = allocate_array(vertices + 1, sizeof *shape->vertices); /* see shape.h */
    shape->triangles = allocate_array(triangles, sizeof *shape->triangles);
    if (parts & MESH_NORMALS)
        shape->normals = allocate_array(vertices, sizeof *shape->normals);
    if (parts & MESH_UV)
        shape->uv = allocate_array(vertices, sizeof *shape->uv);
    if (parts & MESH_SECOND_UV)
        shape->second_uv = allocate_array(vertices, sizeof *shape->second_uv);
    if (parts & MESH_COLORS)
        shape->colors = allocate_array(vertices, sizeof *shape->colors);
    shape->vertex_count = vertices;
    shape->triangle_count = triangles;
    if (shape->vertices && shape->triangles && (shape->normals || !(parts & MESH_NORMALS)) &&
        (shape->uv || !(parts & MESH_UV)) && (shape->second_uv || !(parts & MESH_SECOND_UV)) &&
        (shape->colors || !(parts & MESH_COLORS)))
        return PS_OK;
    return error_memory(
        error, vertices * sizeof *shape->vertices + triangles * sizeof *shape->triangles, "a mesh");
}

void shape_release(struct shape *shape)
{
    free(shape->vertices);
    free(shape->triangles);
    free(shape->normals);
    free(shape->uv);
    free(shape->second_uv);
    free(shape->colors);
    *shape = (struct shape){.kind = SHAPE_MESH};
}

void shape_mesh_uv(const float (*uv)[2], const struct shape_point *point, float at[2])
{
    const float *shares = point->shares;
    at[0] = at[1] = 0.0f;
    for (int k = 0; k < 2 && uv; k++)
        at[k] = shares[0] * uv[point->corners[0]][k] + shares[1] * uv[point->corners[1]][k] +
                shares[2] * uv[point->corners[2]][k];
}

void shape_mesh_color(const struct shape *shape, const struct shape_point *point, float rgba[4])
{
    for (int k = 0; k < 4; k++) {
        rgba[k] = shape->colors ? 0.0f : 1.0f;
        for (int i = 0; i < 3 && shape->colors; i++)
            rgba[k] += point->shares[i] * shape->colors[point->corners[i]][k];
    }
}
