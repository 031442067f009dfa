/* obj_polygon.c: polygons of an OBJ file, which are read as fans, so that no triangle lies outside
 * of them. */
#include "import/obj.h"

#include "scene/polygon.h"
#include "scene/vector.h"
#include <stdlib.h>

/* Room for the largest polygon. */
struct knife {
    uint32_t (*corners)[3]; /* place, uv and normal of each */
    double (*points)[2];
    uint32_t *ring;
    uint32_t (*triangles)[3];
};

/* The corners of a polygon, from the fan that it is. */
static void gather_corners(const struct obj_text *text, const struct obj_polygon *polygon,
                           const struct knife *knife)
{
    uint32_t(*kinds[3])[3] = {text->triangles, text->triangle_uv, text->triangle_normals};
    for (uint32_t i = 0; i < polygon->corners; i++)
        for (int kind = 0; kind < 3; kind++)
            knife->corners[i][kind] =
                kinds[kind] ? kinds[kind][polygon->triangle + (i < 2 ? 0 : i - 2)][i < 2 ? i : 2]
                            : OBJ_NONE;
}

static struct vector point_of(const struct obj_text *text, const uint32_t corner[3])
{
    const ps_vec3 p = text->places[corner[0]];
    return (struct vector){p.x, p.y, p.z};
}

/* Along the normal, as long as twice the area (Sutherland, Sproull and Schumacker 1974, after M.
 * Newell). */
static struct vector polygon_normal(const struct obj_text *text, const uint32_t (*corners)[3],
                                    size_t count)
{
    struct vector normal = {0, 0, 0}, first = point_of(text, corners[0]);
    for (size_t i = 1; i + 1 < count; i++)
        normal = vector_add(normal,
                            vector_cross(vector_subtract(point_of(text, corners[i]), first),
                                         vector_subtract(point_of(text, corners[i + 1]), first)));
    return normal;
}

static bool is_convex(const struct obj_text *text, const uint32_t (*corners)[3], size_t count,
                      struct vector normal)
{
    for (size_t i = 0; i < count; i++) {
        struct vector a = point_of(text, corners[i]), b = point_of(text, corners[(i + 1) % count]);
        struct vector c = point_of(text, corners[(i + 2) % count]);
        struct vector turn = vector_cross(vector_subtract(b, a), vector_subtract(c, b));
        if (!(vector_dot(turn, normal) >= 0))
            return false;
    }
    return true;
}

/* Without the axis along which the polygon is seen best. */
static void flatten(const struct obj_text *text, const uint32_t (*corners)[3], size_t count,
                    struct vector normal, double (*points)[2])
{
    double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    for (size_t i = 0; i < count; i++) {
        struct vector p = point_of(text, corners[i]);
        points[i][0] = x > y && x > z ? p.y : p.x;
        points[i][1] = x > y && x > z ? p.z : y > z ? p.z : p.y;
    }
}

static void store_triangle(const struct obj_text *text, size_t triangle, const struct knife *knife,
                           const uint32_t cut[3])
{
    uint32_t(*kinds[3])[3] = {text->triangles, text->triangle_uv, text->triangle_normals};
    for (int kind = 0; kind < 3; kind++)
        for (int k = 0; kinds[kind] && k < 3; k++)
            kinds[kind][triangle][k] = knife->corners[cut[k]][kind];
}

/* A convex quadrangle stays the fan that it is, as other programs cut it. One that crosses itself
 * may give fewer triangles: the others have no area. */
static void cut_polygon(const struct obj_text *text, const struct obj_polygon *polygon,
                        const struct knife *knife)
{
    static const uint32_t none[3] = {0, 0, 0};
    const uint32_t(*corners)[3] = (const uint32_t(*)[3])knife->corners;
    size_t count = polygon->corners;
    gather_corners(text, polygon, knife);
    struct vector normal = polygon_normal(text, corners, count);
    if (count == 4 && is_convex(text, corners, count, normal))
        return;
    flatten(text, corners, count, normal, knife->points);
    size_t made = polygon_triangulate((const double(*)[2])knife->points, count, knife->ring,
                                      knife->triangles);
    for (size_t i = 0; i < count - 2; i++)
        store_triangle(text, polygon->triangle + i, knife, i < made ? knife->triangles[i] : none);
}

bool obj_cut_polygons(const struct obj_text *text)
{
    size_t most = 0;
    for (size_t i = 0; i < text->polygon_count; i++)
        most = text->polygons[i].corners > most ? text->polygons[i].corners : most;
    struct knife knife = {
        .corners = malloc((most + 1) * sizeof *knife.corners),
        .points = malloc((most + 1) * sizeof *knife.points),
        .ring = malloc((most + 1) * sizeof *knife.ring),
        .triangles = malloc((most + 1) * sizeof *knife.triangles),
    };
    bool good = knife.corners && knife.points && knife.ring && knife.triangles;
    for (size_t i = 0; good && i < text->polygon_count; i++)
        cut_polygon(text, &text->polygons[i], &knife);
    free(knife.corners);
    free(knife.points);
    free(knife.ring);
    free(knife.triangles);
    return good;
}
