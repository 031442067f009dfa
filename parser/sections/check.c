/* check.c: see check.h. Vectors are compared in double, where no float overflows. */
#include "parser/sections/check.h"

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

static bool is_zero(ps_vec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

ps_vec3 check_unit(ps_vec3 v)
{
    const double x = v.x, y = v.y, z = v.z;
    double length = hypot(hypot(x, y), z);
    if (length == 0)
        return v;
    return (ps_vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
}

/* Also where one of them is 0. */
static bool are_parallel(const double a[3], const double b[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0];
    double lengths = hypot(hypot(a[0], a[1]), a[2]) * hypot(hypot(b[0], b[1]), b[2]);
    return hypot(hypot(x, y), z) <= PARALLEL_SINE * lengths;
}

/* Whether `up` is along the way from one point to the other. */
static bool is_up_along(ps_vec3 from, ps_vec3 to, ps_vec3 up_direction)
{
    const double view[3] = {(double)to.x - from.x, (double)to.y - from.y, (double)to.z - from.z};
    const double up[3] = {up_direction.x, up_direction.y, up_direction.z};
    return are_parallel(view, up);
}

/* Reports what is wrong where `good` is false. */
static bool expect(const struct reader *reader, bool good, const struct node *at,
                   const char *message)
{
    if (!good)
        reader_error(reader, at, "%s", message);
    return good;
}

static bool check_projection(const struct reader *reader, const struct node *at,
                             const struct node *map, const struct camera_description *camera)
{
    if (camera->kind == CAMERA_PERSPECTIVE)
        return expect(reader, camera->width == 0, value_of(map, at, "width"),
                      "width is of an orthographic camera; a perspective one has an angle");
    bool good = expect(reader, camera->width > 0, at,
                       "missing key 'width' in camera, which an orthographic one requires");
    const char *angle = camera->angle > 0 ? "angle" : "vertical_angle";
    return expect(reader, camera->angle == 0 && camera->vertical_angle == 0,
                  value_of(map, at, angle),
                  "an orthographic camera has no angle; it has a width") &&
           good;
}

bool check_camera(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct camera_description *camera)
{
    bool good = check_projection(reader, at, map, camera);
    if (is_same(camera->location, camera->look_at))
        return expect(reader, false, value_of(map, at, "look_at"),
                      "look_at is the camera's location; it must be another point");
    return expect(reader, !is_up_along(camera->location, camera->look_at, camera->up),
                  value_of(map, at, "up"),
                  "up is along the direction of view; the camera's roll is undefined") &&
           good;
}

bool check_look_at(const struct reader *reader, const struct item *item,
                   const struct look_at_keys *keys)
{
    if (is_same(keys->from, keys->to))
        return expect(reader, false, value_of(item->value, item->key, "to"),
                      "to in look_at is the same as from; it must be another point");
    return expect(reader, !is_up_along(keys->from, keys->to, keys->up),
                  value_of(item->value, item->key, "up"),
                  "up in look_at is along the way from 'from' to 'to'");
}

static bool check_spotlight(const struct reader *reader, const struct node *at,
                            const struct node *map, const struct light_description *light)
{
    bool good =
        expect(reader, !is_same(light->location, light->point_at), value_of(map, at, "point_at"),
               "point_at is the spotlight's location; it must be another point");
    if (light->radius <= light->falloff)
        return good;
    const struct node *radius =
        node_find(map, "radius") ? value_of(map, at, "radius") : value_of(map, at, "falloff");
    reader_error(reader, radius, "radius %g%s is larger than falloff %g%s in spotlight",
                 light->radius, node_find(map, "radius") ? "" : " (the default)", light->falloff,
                 node_find(map, "falloff") ? "" : " (the default)");
    return false;
}

bool check_light(const struct reader *reader, const struct node *at, const struct node *map,
                 const struct light_description *light)
{
    bool directed = light->kind == LIGHT_SUN || light->kind == LIGHT_DISC;
    bool good = expect(reader, !directed || !is_zero(light->direction),
                       value_of(map, at, "direction"), "the length of direction is 0");
    if (light->kind == LIGHT_SPOT)
        return check_spotlight(reader, at, map, light);
    if (light->kind == LIGHT_SUN)
        return expect(reader, light->unit != UNIT_RADIANCE || light->angle > 0,
                      value_of(map, at, "radiance"),
                      "a sun of angle 0 is a point, which has no radiance; give irradiance") &&
               good;
    if (light->kind == LIGHT_SKY)
        return expect(reader, node_find(map, "radiance") || node_find(map, "file"), at,
                      "sky needs one of radiance, file");
    return good;
}

static bool check_cone(const struct reader *reader, const struct node *at, const struct node *map,
                       const struct object_description *object)
{
    bool good = expect(reader, !is_same(object->points[0], object->points[1]),
                       value_of(map, at, "to"), "its two ends are at the same point");
    return expect(reader,
                  object->kind == OBJECT_CYLINDER || object->radius > 0 || object->to_radius > 0,
                  value_of(map, at, "to_radius"), "both radii of the cone are 0") &&
           good;
}

static bool check_disc(const struct reader *reader, const struct node *at, const struct node *map,
                       const struct object_description *object)
{
    return expect(reader, object->kind != OBJECT_DISC || object->hole_radius < object->radius,
                  value_of(map, at, "hole"), "the hole is as large as the disc");
}

static bool check_count(const struct reader *reader, const struct node *map, const char *key,
                        size_t count, size_t vertex_count)
{
    const struct item *item = node_find(map, key);
    if (!item || count == vertex_count)
        return true;
    reader_error(reader, item->value,
                 "%s in triangles: expected one for each of %zu vertices, got %zu", key,
                 vertex_count, count);
    return false;
}

static bool check_triangles(const struct reader *reader, const struct node *map,
                            const struct object_keys *keys)
{
    bool good = check_count(reader, map, "normals", keys->normals.count, keys->vertices.count);
    good = check_count(reader, map, "uv", keys->uv.count, keys->vertices.count) && good;
    const struct item *item = node_find(map, "normals");
    const ps_vec3 *normal = keys->normals.items;
    for (const struct item *each = item ? item->value->first : NULL; each; each = each->next)
        good = expect(reader, !is_zero(*normal++), each->value, "the length of this normal is 0") &&
               good;
    return good;
}

bool check_object(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct object_keys *keys)
{
    const struct object_description *object = &keys->object;
    bool facing = object->kind == OBJECT_DISC || object->kind == OBJECT_PLANE;
    bool good = expect(reader, !facing || !is_zero(object->normal), value_of(map, at, "normal"),
                       "the length of normal is 0");
    switch (object->kind) {
    case OBJECT_TRIANGLES:
        return check_triangles(reader, map, keys);
    case OBJECT_CYLINDER:
    case OBJECT_CONE:
        return check_cone(reader, at, map, object);
    case OBJECT_DISC:
        return check_disc(reader, at, map, object) && good;
    case OBJECT_TORUS:
        return expect(reader, object->minor_radius < object->radius,
                      value_of(map, at, "minor_radius"),
                      "minor_radius must be smaller than radius");
    default:
        return good;
    }
}
