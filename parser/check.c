/* check.c: see check.h. Vectors are compared in double, where no float overflows. */
#include "parser/check.h"

#include <math.h>

/* The sine below which two directions count as parallel. */
#define PARALLEL_SINE 1e-6

static const struct node *value_of(const struct node *map, const struct node *at, const char *key)
{
    const struct item *item = node_find(map, key);
    return item ? item->value : at;
}

static bool is_same(ps_vec3 a, ps_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Also where one of them is 0. */
static bool are_parallel(const double a[3], const double b[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0];
    double lengths = hypot(hypot(a[0], a[1]), a[2]) * hypot(hypot(b[0], b[1]), b[2]);
    return hypot(hypot(x, y), z) <= PARALLEL_SINE * lengths;
}

void check_camera(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct camera_description *camera)
{
    const ps_vec3 from = camera->location, to = camera->look_at;
    const double view[3] = {(double)to.x - from.x, (double)to.y - from.y, (double)to.z - from.z};
    const double up[3] = {camera->up.x, camera->up.y, camera->up.z};
    if (camera->angle > 0 && camera->vertical_angle > 0)
        reader_error(reader, value_of(map, at, "vertical_angle"),
                     "camera has both angle and vertical_angle; give one of them");
    if (is_same(from, to))
        reader_error(reader, value_of(map, at, "look_at"),
                     "look_at is the camera's location; it must be another point");
    else if (are_parallel(view, up))
        reader_error(reader, value_of(map, at, "up"),
                     "up is along the direction of view; the camera's roll is undefined");
}

void check_light(const struct reader *reader, const struct node *at, const struct node *map,
                 const struct light_description *light)
{
    if (light->kind != LIGHT_SPOT)
        return;
    if (is_same(light->location, light->point_at))
        reader_error(reader, value_of(map, at, "point_at"),
                     "point_at is the spotlight's location; it must be another point");
    if (light->radius > light->falloff)
        reader_error(reader, value_of(map, at, "radius"),
                     "radius %g is larger than falloff %g%s in spotlight", light->radius,
                     light->falloff, node_find(map, "falloff") ? "" : " (the default)");
}

void check_object(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct object_description *object)
{
    ps_vec3 scale = object->transform.scale;
    const struct node *value = value_of(map, at, "scale");
    if (scale.x == 0 || scale.y == 0 || scale.z == 0)
        reader_error(reader, value, "a factor of scale is 0");
    else if (object->kind == OBJECT_SPHERE &&
             (fabsf(scale.x) != fabsf(scale.y) || fabsf(scale.x) != fabsf(scale.z)))
        reader_error(reader, value, "a sphere can only be scaled by equal factors");
}
