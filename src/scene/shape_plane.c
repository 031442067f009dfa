/* shape_plane.c: a plane, as a square large enough.
 *
 * The plane holds the points with normal . p = distance. A distance that is to be found puts it
 * where its front has all corners of the box around the other objects before it, and a little
 * lower: faces that lie in one plane would hide each other by chance. With a stated extent the
 * square lies around the plane's point next to the origin, and a placement stretches it with the
 * rest. Without one it is meant to go on for ever, so it is chosen where the shape will be: a true
 * square around the surroundings. That is carried back to lengths along the plane's own axes, which
 * make (u, v), so that pictures and placement treat both alike.
 */
#include "scene/shape_build.h"

/* Half the width of the square, in radii of the surroundings, or in units where there are none. */
#define AUTO_RADII 4.0f
#define AUTO_ALONE 1.0f

/* How far below the box, of its diagonal. */
#define AUTO_GAP 1e-3

/* p = origin + s u + t v */
struct sheet {
    ps_vec3 origin, u, v;
};

/* Along the unit normal from the origin, in the object's space, to just below the box. With the
 * placement A, T and the placed plane's unit normal m, that is t where m . (A n t + T) = the lowest
 * of the box along m. */
static double distance_below(const struct affine *placement, ps_vec3 normal, const struct box *box)
{
    if (!box || box_is_empty(box))
        return 0.0;
    ps_vec3 placed = unit_or_zero(affine_normal(placement, normal));
    ps_vec3 step = affine_direction(placement, normal);
    if (ps_dot(placed, step) < 0.0f)
        placed = ps_scale(placed, -1.0f); /* of a placement that mirrors */
    double lowest = INFINITY;
    for (unsigned i = 0; i < 8; i++)
        lowest = fmin(lowest, (double)ps_dot(placed, box_corner(box, i)));
    lowest -= AUTO_GAP * (double)ps_length(ps_subtract(box->high, box->low));
    return (lowest - (double)ps_dot(placed, placement->translation)) / (double)ps_dot(placed, step);
}

static struct sheet sheet_of(const struct object_description *object,
                             const struct shape_surroundings *surroundings)
{
    ps_vec3 n = object->normal, normal = unit_or_zero(n);
    double length = sqrt((double)n.x * n.x + (double)n.y * n.y + (double)n.z * n.z);
    double distance = object->distance == DISTANCE_BELOW_ALL
                          ? distance_below(&object->placement, normal, surroundings->box)
                          : object->distance / length;
    struct sheet sheet;
    shape_frame(normal, &sheet.u, &sheet.v);
    sheet.origin = ps_scale(normal, (float)distance);
    return sheet;
}

static void stated_corners(float extent, float corners[4][2])
{
    for (int i = 0; i < 4; i++) {
        corners[i][0] = i == 1 || i == 2 ? extent : -extent;
        corners[i][1] = i >= 2 ? extent : -extent;
    }
}

static void automatic_corners(const struct sheet *sheet, const struct affine *placement,
                              const struct shape_surroundings *surroundings, float corners[4][2])
{
    ps_vec3 origin = affine_point(placement, sheet->origin);
    ps_vec3 u = affine_direction(placement, sheet->u), v = affine_direction(placement, sheet->v);
    ps_vec3 u_unit = unit_or_zero(u), v_unit = unit_or_zero(v);
    ps_vec3 normal = unit_or_zero(ps_cross(u_unit, v_unit));
    ps_vec3 across = ps_cross(normal, u_unit);
    bool alone = !(surroundings->radius > 0.0f);
    float extent = alone ? AUTO_ALONE : AUTO_RADII * surroundings->radius;
    ps_vec3 middle = ps_subtract(alone ? origin : surroundings->center, origin);
    /* v = v_u u_unit + v_across across: p = s u + t v is solved from the last component. */
    float v_u = ps_dot(v, u_unit), v_across = ps_dot(v, across), length = ps_length(u);
    stated_corners(extent, corners);
    for (int i = 0; i < 4; i++) {
        float t = (ps_dot(middle, across) + corners[i][1]) / v_across;
        corners[i][0] = (ps_dot(middle, u_unit) + corners[i][0] - t * v_u) / length;
        corners[i][1] = t;
    }
}

static const char *check_plane(const struct object_description *object)
{
    if (!has_direction(object->normal))
        return "normal has no direction";
    if (object->distance != DISTANCE_BELOW_ALL && !(fabs(object->distance) <= (double)FLT_MAX))
        return "distance is out of range";
    return is_length_or_zero(object->extent) ? NULL : "extent must be 0 or above";
}

ps_result shape_plane(const struct object_description *object,
                      const struct shape_surroundings *surroundings, struct shape *shape,
                      struct error *error)
{
    const char *wrong = check_plane(object);
    if (wrong)
        return shape_invalid(object, error, wrong);
    ps_result result = shape_allocate(shape, 4, 2, MESH_UV, error);
    if (result != PS_OK)
        return result;
    struct sheet sheet = sheet_of(object, surroundings);
    if (object->extent > 0.0)
        stated_corners((float)object->extent, shape->uv);
    else
        automatic_corners(&sheet, &object->placement, surroundings, shape->uv);
    for (int i = 0; i < 4; i++) {
        ps_vec3 p = ps_add_scaled(sheet.origin, shape->uv[i][0], sheet.u);
        shape->vertices[i] = ps_add_scaled(p, shape->uv[i][1], sheet.v);
    }
    set_square(shape->triangles, 0);
    return PS_OK;
}
