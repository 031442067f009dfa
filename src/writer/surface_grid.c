/* surface_grid.c: a surface by two parameters as a mesh; see mesh.h. */
#include "writer/mesh.h"

#include <math.h>

#define STEP 1e-4 /* of a parameter, between the points of a difference */

/* By differences; beside a pole, where one of them is 0. */
static struct vector normal_at(const struct surface_function *surface, double u, double v)
{
    double u0 = fmax(u - STEP, 0.0), u1 = fmin(u + STEP, 1.0);
    double near_v = fmin(fmax(v, 10.0 * STEP), 1.0 - 10.0 * STEP);
    struct vector along_u = vector_subtract(surface->point(surface->user, u1, near_v),
                                            surface->point(surface->user, u0, near_v));
    struct vector along_v = vector_subtract(surface->point(surface->user, u, near_v + STEP),
                                            surface->point(surface->user, u, near_v - STEP));
    struct vector n = vector_cross(along_u, along_v);
    double length = vector_length(n);
    return length > 0.0 ? (struct vector){n.x / length, n.y / length, n.z / length} : n;
}

/* Beside a pole triangles have no area. */
static bool has_area(const struct mesh *mesh, const uint32_t corners[3])
{
    struct vector a = vector_subtract(mesh->points[corners[1]], mesh->points[corners[0]]);
    struct vector b = vector_subtract(mesh->points[corners[2]], mesh->points[corners[0]]);
    double longest = fmax(vector_dot(a, a), vector_dot(b, b));
    return vector_length(vector_cross(a, b)) > 1e-9 * longest;
}

bool mesh_from_surface(const struct surface_function *surface, struct mesh *mesh)
{
    size_t across = surface->columns + 1, down = surface->rows + 1;
    if (!mesh_allocate(mesh, across * down, true, true, 2 * surface->columns * surface->rows))
        return false;
    for (size_t j = 0; j < down; j++)
        for (size_t i = 0; i < across; i++) {
            double u = (double)i / (double)surface->columns, v = (double)j / (double)surface->rows;
            mesh->points[j * across + i] = surface->point(surface->user, u, v);
            mesh->normals[j * across + i] = normal_at(surface, u, v);
            mesh->uv[j * across + i][0] = u;
            mesh->uv[j * across + i][1] = v;
        }
    size_t count = 0;
    for (size_t j = 0; j < surface->rows; j++)
        for (size_t i = 0; i < surface->columns; i++) {
            uint32_t a = (uint32_t)(j * across + i), b = a + 1, c = b + (uint32_t)across,
                     d = a + (uint32_t)across;
            const uint32_t corners[2][3] = {{a, b, c}, {a, c, d}};
            for (int t = 0; t < 2; t++) {
                for (int k = 0; k < 3; k++)
                    mesh->triangles[count][k] = corners[t][k];
                count += has_area(mesh, corners[t]);
            }
        }
    mesh->triangle_count = count;
    return true;
}
