/* shape_flat.c: shapes that are given by their corners: quads, boxes, triangles and meshes. */
#include "scene/shape_build.h"

#include <string.h>

ps_result shape_quad(const struct object_description *object,
                     const struct shape_surroundings *surroundings, struct shape *shape,
                     struct error *error)
{
    static const float uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    (void)surroundings;
    ps_result result = shape_allocate(shape, 4, 2, MESH_UV, error);
    if (result != PS_OK)
        return result;
    memcpy(shape->vertices, object->vertices, 4 * sizeof *shape->vertices);
    memcpy(shape->uv, uv, sizeof uv);
    set_square(shape->triangles, 0);
    return PS_OK;
}

/* A face of a box. Corner i has x, y, z of the high corner where bits 0, 1, 2 of i are set; u and v
 * are one of these bits, or the opposite of one. */
struct face {
    unsigned char corners[4];
    unsigned char u_bit, u_opposite, v_bit, v_opposite;
};

static const struct face faces[6] = {
    {{0, 2, 3, 1}, 0, 1, 1, 0}, /* -z: u = -x, v = y */
    {{4, 5, 7, 6}, 0, 0, 1, 0}, /* +z: u = x, v = y */
    {{0, 1, 5, 4}, 0, 0, 2, 0}, /* -y: u = x, v = z */
    {{2, 6, 7, 3}, 0, 0, 2, 1}, /* +y: u = x, v = -z */
    {{0, 4, 6, 2}, 2, 0, 1, 0}, /* -x: u = z, v = y */
    {{1, 3, 7, 5}, 2, 1, 1, 0}, /* +x: u = -z, v = y */
};

static void set_face(struct shape *shape, size_t i, ps_vec3 low, ps_vec3 high)
{
    const struct face *face = &faces[i];
    for (size_t k = 0; k < 4; k++) {
        unsigned corner = face->corners[k];
        shape->vertices[4 * i + k] = (ps_vec3){
            corner & 1 ? high.x : low.x,
            corner & 2 ? high.y : low.y,
            corner & 4 ? high.z : low.z,
        };
        shape->uv[4 * i + k][0] = (float)((corner >> face->u_bit & 1u) ^ face->u_opposite);
        shape->uv[4 * i + k][1] = (float)((corner >> face->v_bit & 1u) ^ face->v_opposite);
    }
    set_square(&shape->triangles[2 * i], (uint32_t)(4 * i));
}

/* NULL: nothing is wrong. */
static const char *check_box(const struct object_description *object)
{
    ps_vec3 size = ps_subtract(object->vertices[1], object->vertices[0]);
    return size.x != 0.0f && size.y != 0.0f && size.z != 0.0f
               ? NULL
               : "its corners agree in a coordinate, so it has no volume; a quad is flat";
}

ps_result shape_box(const struct object_description *object,
                    const struct shape_surroundings *surroundings, struct shape *shape,
                    struct error *error)
{
    (void)surroundings;
    const char *wrong = check_box(object);
    if (wrong)
        return shape_invalid(object, error, wrong);
    ps_result result = shape_allocate(shape, 24, 12, MESH_UV, error);
    if (result != PS_OK)
        return result;
    ps_vec3 a = object->vertices[0], b = object->vertices[1];
    ps_vec3 low = {fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)};
    ps_vec3 high = {fmaxf(a.x, b.x), fmaxf(a.y, b.y), fmaxf(a.z, b.z)};
    for (size_t i = 0; i < 6; i++)
        set_face(shape, i, low, high);
    return PS_OK;
}

static ps_result copy_mesh(const struct mesh_description *mesh, struct shape *shape,
                           struct error *error)
{
    unsigned parts = (mesh->normals ? MESH_NORMALS : 0u) | (mesh->uv ? MESH_UV : 0u) |
                     (mesh->second_uv ? MESH_SECOND_UV : 0u) | (mesh->colors ? MESH_COLORS : 0u);
    ps_result result =
        shape_allocate(shape, mesh->vertex_count, mesh->triangle_count, parts, error);
    if (result != PS_OK)
        return result;
    if (mesh->vertex_count)
        memcpy(shape->vertices, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    if (mesh->triangle_count)
        memcpy(shape->triangles, mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    if (mesh->normals && mesh->vertex_count)
        memcpy(shape->normals, mesh->normals, mesh->vertex_count * sizeof *mesh->normals);
    if (mesh->uv && mesh->vertex_count)
        memcpy(shape->uv, mesh->uv, mesh->vertex_count * sizeof *mesh->uv);
    if (mesh->second_uv && mesh->vertex_count)
        memcpy(shape->second_uv, mesh->second_uv, mesh->vertex_count * sizeof *mesh->second_uv);
    if (mesh->colors && mesh->vertex_count)
        memcpy(shape->colors, mesh->colors, mesh->vertex_count * sizeof *mesh->colors);
    return PS_OK;
}

ps_result shape_triangles(const struct object_description *object,
                          const struct shape_surroundings *surroundings, struct shape *shape,
                          struct error *error)
{
    (void)surroundings;
    const struct mesh_description list = {
        .vertices = object->vertices,
        .vertex_count = object->vertex_count,
        .triangles = object->triangles,
        .triangle_count = object->triangle_count,
    };
    return copy_mesh(&list, shape, error);
}

ps_result shape_mesh(const struct object_description *object,
                     const struct shape_surroundings *surroundings, struct shape *shape,
                     struct error *error)
{
    if (!surroundings->meshes)
        return shape_invalid(object, error, "there are no meshes");
    return copy_mesh(&surroundings->meshes[object->mesh], shape, error);
}
