/* camera_frame.c: the nearest location from which a direction of view shows all corners of a box.
 *
 * With the view's right r, up u, forward f and the tangents t_r, t_u of half the field of view, a
 * corner p is in the picture of a camera at c where
 *
 *     |(p - c) . r| <= t_r (p - c) . f,    and the same of u and t_u.
 *
 * For r, with R = max (p.r - t_r p.f) and L = max (-p.r - t_r p.f), that is
 *
 *     c.f <= -(R + L) / (2 t_r),   where c.r = (R - L) / 2 is in the middle of what is left,
 *
 * so that c.f is the smaller of what r and u allow. A sphere around the box would be simpler, and
 * lets it look small.
 */
#include "scene/camera_frame.h"

#include "scene/vector.h"
#include <float.h>

/* The view from a model's front: 29 degrees to the right; raised by 20 degrees, and by 40 what is
 * flat, of which a lower view shows little. */
#define TURN 29.0
#define RAISED 20.0
#define RAISED_FLAT 40.0

#define USED_SHARE 0.88     /* of the picture's width and height */
#define LEAST_DISTANCE 0.05 /* from the box, of its diagonal */
#define ANGLE 35.0          /* along the longer side, degrees */

#define RADIANS (3.14159265358979323846 / 180.0)

static struct vector add_scaled(struct vector a, double s, struct vector b)
{
    return (struct vector){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static struct vector unit(struct vector v)
{
    double length = vector_length(v);
    return (struct vector){v.x / length, v.y / length, v.z / length};
}

static ps_vec3 rounded(struct vector v)
{
    return (ps_vec3){(float)v.x, (float)v.y, (float)v.z};
}

/* Axes of what is seen: forward from the camera. */
struct view {
    struct vector right, up, forward;
};

static struct view view_along(struct vector forward, ps_vec3 up)
{
    struct vector f = unit(forward), right = unit(vector_cross(f, unit(vector_of(up))));
    return (struct view){right, vector_cross(right, f), f};
}

/* --- the direction of view
 * ------------------------------------------------------------------------ */

/* The shortest turn from y to the axis; from -y it is about x. Rodrigues' formula for the axis y x
 * up. */
static struct vector turned_with_up(struct vector v, struct vector up)
{
    if (up.y < -1.0 + 1e-9)
        return (struct vector){v.x, -v.y, -v.z};
    struct vector k = {up.z, 0.0, -up.x};
    struct vector turned = add_scaled((struct vector){0, 0, 0}, up.y, v);
    turned = add_scaled(turned, 1.0, vector_cross(k, v));
    return add_scaled(turned, vector_dot(k, v) / (1.0 + up.y), k);
}

/* Length of the box along an axis. */
static double extent_along(const struct box *box, struct vector axis)
{
    struct vector size = vector_of(ps_subtract(box->high, box->low));
    return fabs(axis.x) * size.x + fabs(axis.y) * size.y + fabs(axis.z) * size.z;
}

/* From the box to the camera. */
static struct vector three_quarter(const struct box *box, struct vector up)
{
    struct vector right = turned_with_up((struct vector){1, 0, 0}, up);
    struct vector front = turned_with_up((struct vector){0, 0, 1}, up);
    double width = fmax(extent_along(box, right), extent_along(box, front));
    double flatness = 1.0 - fmin(2.0 * extent_along(box, up) / width, 1.0);
    double raised = RADIANS * (RAISED + (RAISED_FLAT - RAISED) * flatness);
    struct vector level = add_scaled((struct vector){0, 0, 0}, sin(RADIANS * TURN), right);
    level = add_scaled(level, cos(RADIANS * TURN), front);
    return add_scaled(add_scaled((struct vector){0, 0, 0}, cos(raised), level), sin(raised), up);
}

/* --- the distance
 * --------------------------------------------------------------------------------- */

static double diagonal_of(const struct box *box)
{
    struct vector size = vector_of(ps_subtract(box->high, box->low));
    return vector_length(size);
}

/* A wide view shows all from next to the nearest corner: the depth before that where the camera may
 * be at most. */
static double nearest_depth(const struct box *box, struct vector forward)
{
    double nearest = DBL_MAX;
    for (unsigned i = 0; i < 8; i++)
        nearest = fmin(nearest, vector_dot(vector_of(box_corner(box, i)), forward));
    return nearest - LEAST_DISTANCE * diagonal_of(box);
}

/* Of the corners along one side of the picture: the largest of p.side - t p.f and of -p.side - t
 * p.f. */
struct span {
    double high, low;
};

static struct span span_of(const struct box *box, struct vector side, struct vector forward,
                           double tangent)
{
    struct span span = {-DBL_MAX, -DBL_MAX};
    for (unsigned i = 0; i < 8; i++) {
        struct vector p = vector_of(box_corner(box, i));
        double across = vector_dot(p, side), depth = tangent * vector_dot(p, forward);
        span.high = fmax(span.high, across - depth);
        span.low = fmax(span.low, -across - depth);
    }
    return span;
}

struct tangents {
    double across, up; /* of half the field of view, less the margin */
};

static struct tangents tangents_of(const struct camera_description *camera, double aspect)
{
    double across = camera->vertical_angle > 0
                        ? tan(0.5 * RADIANS * camera->vertical_angle) * aspect
                        : tan(0.5 * RADIANS * camera->angle);
    return (struct tangents){USED_SHARE * across, USED_SHARE * across / aspect};
}

static struct vector perspective_location(const struct box *box, const struct view *view,
                                          struct tangents tangents)
{
    struct span across = span_of(box, view->right, view->forward, tangents.across);
    struct span up = span_of(box, view->up, view->forward, tangents.up);
    double depth = fmin(-(across.high + across.low) / (2.0 * tangents.across),
                        -(up.high + up.low) / (2.0 * tangents.up));
    depth = fmin(depth, nearest_depth(box, view->forward));
    struct vector location = {0, 0, 0};
    location = add_scaled(location, 0.5 * (across.high - across.low), view->right);
    location = add_scaled(location, 0.5 * (up.high - up.low), view->up);
    return add_scaled(location, depth, view->forward);
}

/* The same where the point `target` must be in the middle: the distance from there. */
static double perspective_distance(const struct box *box, const struct view *view,
                                   struct vector target, struct tangents tangents)
{
    double distance = vector_dot(target, view->forward) - nearest_depth(box, view->forward);
    distance = fmax(distance, LEAST_DISTANCE * diagonal_of(box)); /* of a target before the box */
    for (unsigned i = 0; i < 8; i++) {
        struct vector p = add_scaled(vector_of(box_corner(box, i)), -1.0, target);
        double depth = vector_dot(p, view->forward);
        distance = fmax(distance, fabs(vector_dot(p, view->right)) / tangents.across - depth);
        distance = fmax(distance, fabs(vector_dot(p, view->up)) / tangents.up - depth);
    }
    return distance;
}

/* Half the width that shows all corners around the target, and no less than they need in height. */
static double orthographic_half_width(const struct box *box, const struct view *view,
                                      struct vector target, double aspect)
{
    double half = 0.0;
    for (unsigned i = 0; i < 8; i++) {
        struct vector p = add_scaled(vector_of(box_corner(box, i)), -1.0, target);
        half = fmax(half, fabs(vector_dot(p, view->right)));
        half = fmax(half, fabs(vector_dot(p, view->up)) * aspect);
    }
    return half / USED_SHARE;
}

/* --- all of it
 * ------------------------------------------------------------------------------------ */

static ps_result check_direction(const struct camera_description *camera, struct error *error)
{
    struct vector view = vector_of(ps_subtract(camera->look_at, camera->location));
    struct vector side = vector_cross(view, unit(vector_of(camera->up)));
    if (!(vector_dot(view, view) > 0.0))
        return error_set(error, PS_ERROR_INVALID,
                         "look_at: auto is the camera's location, in the middle of what there is "
                         "to see");
    if (!(vector_dot(side, side) > 1e-12 * vector_dot(view, view)))
        return error_set(error, PS_ERROR_INVALID,
                         "up is along the direction of view to look_at: auto");
    return PS_OK;
}

/* From the side of the box that `away` points to. */
static void find_location(struct camera_description *camera, const struct box *box,
                          struct vector away, double aspect)
{
    struct view view = view_along((struct vector){-away.x, -away.y, -away.z}, camera->up);
    struct vector center = vector_of(box_center(box));
    struct vector target = camera->finds_look_at ? center : vector_of(camera->look_at);
    struct vector location;
    double distance = diagonal_of(box);
    if (camera->kind == CAMERA_ORTHOGRAPHIC) {
        struct vector to_center = add_scaled(center, -1.0, target);
        distance += fabs(vector_dot(to_center, view.forward));
        if (!(camera->width > 0))
            camera->width = 2.0 * orthographic_half_width(box, &view, target, aspect);
        location = add_scaled(target, -distance, view.forward);
    } else if (camera->finds_look_at) {
        location = perspective_location(box, &view, tangents_of(camera, aspect));
        distance = vector_dot(add_scaled(center, -1.0, location), view.forward);
    } else {
        distance = perspective_distance(box, &view, target, tangents_of(camera, aspect));
        location = add_scaled(target, -distance, view.forward);
    }
    camera->location = rounded(location);
    if (camera->finds_look_at)
        camera->look_at = rounded(add_scaled(location, distance, view.forward));
}

void camera_frame_from(struct camera_description *camera, const struct box *box, ps_vec3 away,
                       double aspect)
{
    camera->kind = CAMERA_PERSPECTIVE;
    camera->finds_look_at = true;
    find_location(camera, box, vector_of(away), aspect);
}

ps_result camera_frame(struct camera_description *camera, const struct box *box, size_t width,
                       size_t height, struct error *error)
{
    struct box around = *box;
    double aspect = (double)width / (double)height;
    if (box_is_empty(&around))
        around = (struct box){{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}};
    if (camera->finds_location) {
        if (!(camera->angle > 0) && !(camera->vertical_angle > 0))
            *(aspect >= 1.0 ? &camera->angle : &camera->vertical_angle) = ANGLE;
        find_location(camera, &around, three_quarter(&around, unit(vector_of(camera->up))), aspect);
    } else if (camera->finds_look_at) {
        camera->look_at = box_center(&around);
    }
    return check_direction(camera, error);
}
