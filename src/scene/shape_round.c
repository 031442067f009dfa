/* shape_round.c: cylinder, cone, disc and torus as meshes.
 *
 * Embree has curves and discs of its own, but none with ends, holes or a placement that shears. A
 * mesh is traced as fast, samples as an emitter like any other, and is off by what shape.h states.
 */
#include "scene/shape_lathe.h"

#define PI 3.14159265358979323846

/* A cylinder is a cone whose ends are alike. */
/* --- what makes no shape: NULL where nothing is wrong
 * ---------------------------------------------- */

static const char *check_segments(const struct object_description *object)
{
    _Static_assert(SHAPE_SEGMENTS_MIN == 3 && SHAPE_SEGMENTS_MAX == 8192, "stated in the message");
    return object->segments == 0 || (object->segments >= SHAPE_SEGMENTS_MIN &&
                                     object->segments <= SHAPE_SEGMENTS_MAX)
               ? NULL
               : "segments must be within 3..8192, or 0 for the default";
}

static const char *check_points(const struct object_description *object)
{
    if (!has_direction(ps_subtract(object->points[1], object->points[0])))
        return "its two points are one, or too far away: it has no axis";
    return check_segments(object);
}

static const char *check_cylinder(const struct object_description *object)
{
    if (!is_length(object->radius))
        return "radius must be above 0";
    return check_points(object);
}

static const char *check_cone(const struct object_description *object)
{
    double largest = fmax(object->radius, object->to_radius);
    if (!is_length_or_zero(object->radius) || !is_length_or_zero(object->to_radius))
        return "radius and to_radius must be 0 or above";
    return largest > 0.0 ? check_points(object) : "one of radius and to_radius must be above 0";
}

static const char *check_disc(const struct object_description *object)
{
    if (!has_direction(object->normal))
        return "normal has no direction";
    if (!is_length(object->radius))
        return "radius must be above 0";
    if (!is_length_or_zero(object->hole_radius) ||
        !((float)object->hole_radius < (float)object->radius))
        return "hole_radius must be 0 or above, and below radius";
    return check_segments(object);
}

/* The tube may not reach the axis: there it would meet itself, and its inside would be outside. */
static const char *check_torus(const struct object_description *object)
{
    if (!is_length(object->radius) || !is_length(object->minor_radius))
        return "radius and minor_radius must be above 0";
    if (!((float)object->minor_radius < (float)object->radius))
        return "minor_radius must be below radius";
    return check_segments(object);
}

/* --- shapes
 * ------------------------------------------------------------------------------------ */

static ps_result build_cone(const struct object_description *object, float radius, float to_radius,
                            struct shape *shape, struct error *error)
{
    size_t n = shape_segments(object);
    bool ends[2] = {!object->open && radius > 0.0f, !object->open && to_radius > 0.0f};
    size_t end_count = (size_t)ends[0] + (size_t)ends[1];
    size_t vertices = lathe_ring_vertices(n, radius) + lathe_ring_vertices(n, to_radius) +
                      end_count * lathe_disc_vertices(n, 0.0f);
    size_t triangles =
        lathe_strip_triangles(n, radius, to_radius) + end_count * lathe_disc_triangles(n, 0.0f);
    ps_result result = shape_allocate(shape, vertices, triangles, MESH_NORMALS | MESH_UV, error);
    if (result != PS_OK)
        return result;

    ps_vec3 way = ps_subtract(object->points[1], object->points[0]);
    ps_vec3 axis = unit_or_zero(way);
    float height = ps_dot(way, axis);
    ps_vec3 normal = unit_or_zero((ps_vec3){height, radius - to_radius, 0.0f});
    struct lathe lathe = lathe_begin(shape, object->points[0], axis, n);
    lathe_ring(&lathe, &(struct profile_point){radius, 0.0f, normal.x, normal.y, 0.0f});
    lathe_join(&lathe, &(struct profile_point){to_radius, height, normal.x, normal.y, 1.0f});
    if (ends[0])
        lathe_disc(&lathe, 0.0f, radius, 0.0f, false);
    if (ends[1])
        lathe_disc(&lathe, height, to_radius, 0.0f, true);
    return PS_OK;
}

ps_result shape_cylinder(const struct object_description *object,
                         const struct shape_surroundings *surroundings, struct shape *shape,
                         struct error *error)
{
    (void)surroundings;
    const char *wrong = check_cylinder(object);
    if (wrong)
        return shape_invalid(object, error, wrong);
    return build_cone(object, (float)object->radius, (float)object->radius, shape, error);
}

ps_result shape_cone(const struct object_description *object,
                     const struct shape_surroundings *surroundings, struct shape *shape,
                     struct error *error)
{
    (void)surroundings;
    const char *wrong = check_cone(object);
    if (wrong)
        return shape_invalid(object, error, wrong);
    return build_cone(object, (float)object->radius, (float)object->to_radius, shape, error);
}

ps_result shape_disc(const struct object_description *object,
                     const struct shape_surroundings *surroundings, struct shape *shape,
                     struct error *error)
{
    (void)surroundings;
    const char *wrong = check_disc(object);
    if (wrong)
        return shape_invalid(object, error, wrong);
    size_t n = shape_segments(object);
    float hole = (float)object->hole_radius;
    ps_result result = shape_allocate(shape, lathe_disc_vertices(n, hole),
                                      lathe_disc_triangles(n, hole), MESH_NORMALS | MESH_UV, error);
    if (result != PS_OK)
        return result;
    struct lathe lathe = lathe_begin(shape, object->center, unit_or_zero(object->normal), n);
    lathe_disc(&lathe, 0.0f, (float)object->radius, hole, true);
    return PS_OK;
}

/* Ring i of n of the tube, from the inside down and around. The last is exactly the first. */
static struct profile_point torus_point(const struct object_description *object, size_t i, size_t n)
{
    double angle = 2.0 * PI * (double)(i % n) / (double)n;
    double away = -cos(angle), up = -sin(angle);
    return (struct profile_point){
        .radius = (float)(object->radius + object->minor_radius * away),
        .height = (float)(object->minor_radius * up),
        .normal_radius = (float)away,
        .normal_height = (float)up,
        .v = (float)i / (float)n,
    };
}

ps_result shape_torus(const struct object_description *object,
                      const struct shape_surroundings *surroundings, struct shape *shape,
                      struct error *error)
{
    (void)surroundings;
    const char *wrong = check_torus(object);
    if (wrong)
        return shape_invalid(object, error, wrong);
    size_t n = shape_segments(object), m = n / 2 > 3 ? n / 2 : 3;
    ps_result result =
        shape_allocate(shape, (m + 1) * (n + 1), 2 * m * n, MESH_NORMALS | MESH_UV, error);
    if (result != PS_OK)
        return result;
    struct lathe lathe = lathe_begin(shape, (ps_vec3){0, 0, 0}, (ps_vec3){0, 1, 0}, n);
    struct profile_point point = torus_point(object, 0, m);
    lathe_ring(&lathe, &point);
    for (size_t i = 1; i <= m; i++) {
        point = torus_point(object, i, m);
        lathe_join(&lathe, &point);
    }
    return PS_OK;
}
