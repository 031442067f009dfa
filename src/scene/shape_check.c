/* shape_check.c: which objects have a shape at all.
 *
 * The scene language bounds single numbers as it reads them; what only several numbers together can
 * show (a cone whose ends lie in one place) is found here, before anything is built.
 */
#include "scene/shape_build.h"

#include <float.h>

static const char *kind_name(enum object_kind kind)
{
    static const char *const names[] = {"quad",     "box",          "triangles", "sphere",
                                        "cylinder", "cone",         "disc",      "plane",
                                        "torus",    "height_field", "mesh"};
    return (size_t)kind < sizeof names / sizeof *names ? names[kind] : "object";
}

ps_result shape_invalid(const struct object_description *object, struct error *error,
                        const char *message)
{
    return error_set(error, PS_ERROR_INVALID, "%s: %s", kind_name(object->kind), message);
}

/* A length above 0 that single precision can hold. */
static bool is_length(double value)
{
    return value >= (double)FLT_MIN && value <= (double)FLT_MAX;
}

static bool is_length_or_zero(double value)
{
    return value == 0.0 || is_length(value);
}

static bool has_direction(ps_vec3 v)
{
    return ps_length(unit_or_zero(v)) > 0.0f;
}

/* NULL: nothing is wrong. */
static const char *check_box(const struct object_description *object)
{
    ps_vec3 size = ps_subtract(object->vertices[1], object->vertices[0]);
    return size.x != 0.0f && size.y != 0.0f && size.z != 0.0f
               ? NULL
               : "its corners agree in a coordinate, so it has no volume; a quad is flat";
}

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

static const char *check_plane(const struct object_description *object)
{
    if (!has_direction(object->normal))
        return "normal has no direction";
    if (!(fabs(object->distance) <= (double)FLT_MAX))
        return "distance is out of range";
    return is_length_or_zero(object->extent) ? NULL : "extent must be 0 or above";
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

static const char *check_heights(const struct height_samples *heights)
{
    if (!heights || !heights->samples)
        return "it has no picture";
    if (heights->width < 2 || heights->height < 2)
        return "its picture must be of 2 pixels or more each way";
    if (heights->width > SHAPE_HEIGHT_SAMPLES_MAX / heights->height)
        return "its picture has more than 2^27 pixels";
    for (size_t i = 0; i < heights->width * heights->height; i++)
        if (!isfinite(heights->samples[i]))
            return "its picture holds a value that is no number";
    return NULL;
}

static const char *check_kind(const struct object_description *object,
                              const struct shape_surroundings *surroundings)
{
    switch (object->kind) {
    case OBJECT_QUAD:
    case OBJECT_TRIANGLES:
        return NULL;
    case OBJECT_BOX:
        return check_box(object);
    case OBJECT_SPHERE:
        return is_length(object->radius) ? NULL : "radius must be above 0";
    case OBJECT_CYLINDER:
        return check_cylinder(object);
    case OBJECT_CONE:
        return check_cone(object);
    case OBJECT_DISC:
        return check_disc(object);
    case OBJECT_PLANE:
        return check_plane(object);
    case OBJECT_TORUS:
        return check_torus(object);
    case OBJECT_HEIGHT_FIELD:
        return check_heights(surroundings->heights);
    case OBJECT_MESH:
        return surroundings->meshes ? NULL : "there are no meshes";
    case OBJECT_INSTANCE:
        return "an instance of a group is no shape by itself";
    }
    return "unknown kind of object";
}

ps_result shape_check(const struct object_description *object,
                      const struct shape_surroundings *surroundings, struct error *error)
{
    double determinant = affine_determinant(&object->placement);
    const char *wrong = check_kind(object, surroundings);
    if (!wrong && !(fabs(determinant) > 0.0 && isfinite(determinant)))
        wrong = "its placement makes it flat, or is out of range";
    return wrong ? shape_invalid(object, error, wrong) : PS_OK;
}
