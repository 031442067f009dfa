/* placement.c: from the keys of transforms to an affine map.
 *
 * A map counts as singular where the volume that it makes of a cube is less than a millionth of
 * what the lengths of the edges would allow: singular matrices become regular by rounding.
 */
#include "parser/sections/sections.h"

#include "parser/sections/check.h"
#include "parser/sections/fill.h"
#include <math.h>
#include <psplat/math.h>

#define SMALLEST_SHARE 1e-6

static double length_of(ps_vec3 v)
{
    return hypot(hypot((double)v.x, (double)v.y), (double)v.z);
}

static bool is_finite(ps_vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

bool placement_is_regular(const struct affine *map)
{
    const double x[3] = {map->x.x, map->x.y, map->x.z}, y[3] = {map->y.x, map->y.y, map->y.z};
    const double z[3] = {map->z.x, map->z.y, map->z.z};
    double volume = x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) +
                    x[2] * (y[0] * z[1] - y[1] * z[0]);
    double most = length_of(map->x) * length_of(map->y) * length_of(map->z);
    struct affine inverse;
    return fabs(volume) > SMALLEST_SHARE * most && affine_invert(map, &inverse) &&
           is_finite(map->translation) && is_finite(inverse.x) && is_finite(inverse.y) &&
           is_finite(inverse.z) && is_finite(inverse.translation);
}

static struct affine from_matrix(const double m[12])
{
    return (struct affine){
        {(float)m[0], (float)m[4], (float)m[8]},
        {(float)m[1], (float)m[5], (float)m[9]},
        {(float)m[2], (float)m[6], (float)m[10]},
        {(float)m[3], (float)m[7], (float)m[11]},
    };
}

static bool check_look_at(const struct reader *reader, const struct item *item,
                          const struct look_at_keys *keys)
{
    if (ps_same(keys->from, keys->to))
        return check_expect(reader, false, check_value(item->value, item->key, "to"),
                            "to in look_at is the same as from; it must be another point");
    return check_expect(reader, !check_up_along(keys->from, keys->to, keys->up),
                        check_value(item->value, item->key, "up"),
                        "up in look_at is along the way from 'from' to 'to'");
}

static bool read_look_at(struct reader *reader, const struct item *item, struct affine *placement)
{
    struct look_at_keys keys = {.up = {0, 0, 0}};
    if (!fill_section(reader, schema_only("look_at"), item->key, item->value, &keys) ||
        !check_look_at(reader, item, &keys))
        return false;
    ps_vec3 z = check_unit(ps_subtract(keys.to, keys.from));
    ps_vec3 x = check_unit(ps_cross(check_unit(keys.up), z));
    *placement = (struct affine){x, ps_cross(z, x), z, keys.from};
    return true;
}

/* One of the transforms, or the three that have an order of their own. */
static bool read_plain(struct reader *reader, const struct node *at, const struct node *map,
                       const struct placement_keys *keys, struct affine *placement)
{
    const struct item *matrix = node_find(map, "matrix"), *look_at = node_find(map, "look_at");
    const struct item *scale = node_find(map, "scale");
    const struct node *culprit = at;
    if (look_at)
        return read_look_at(reader, look_at, placement);
    if (matrix) {
        *placement = from_matrix(keys->matrix);
        culprit = matrix->value;
    } else {
        *placement = affine_of(keys->scale, keys->rotate, keys->translate);
        culprit = scale ? scale->value : at;
        if (keys->scale.x == 0 || keys->scale.y == 0 || keys->scale.z == 0) {
            reader_error(reader, culprit, "a factor of scale is 0");
            return false;
        }
    }
    if (placement_is_regular(placement))
        return true;
    reader_error(reader, culprit, "%s is singular: it has no inverse",
                 matrix ? "the matrix" : "the transform");
    return false;
}

static bool read_step(struct reader *reader, const struct node *step, struct affine *placement)
{
    struct placement_keys keys = {.scale = {0, 0, 0}};
    struct affine own;
    if (step->kind != NODE_MAP || step->count != 1) {
        reader_error(reader, step, "expected a map with one key in transform, got %s",
                     step->kind == NODE_MAP ? "another number of keys" : node_kind_name(step));
        return false;
    }
    if (!fill_section(reader, schema_only("transform"), step, step, &keys) ||
        !read_plain(reader, step, step, &keys, &own))
        return false;
    *placement = affine_compose(&own, placement);
    return true;
}

static bool read_steps(struct reader *reader, const struct item *steps, struct affine *placement)
{
    *placement = (struct affine)AFFINE_IDENTITY;
    if (!fill_expect(reader, "transform", steps->value, NODE_LIST))
        return false;
    bool good = true;
    for (const struct item *item = steps->value->first; item; item = item->next)
        good = read_step(reader, item->value, placement) && good;
    if (good && !placement_is_regular(placement)) {
        reader_error(reader, steps->value, "the transform is singular: it has no inverse");
        good = false;
    }
    return good;
}

bool placement_read(struct reader *reader, const struct node *at, const struct node *map,
                    const struct placement_keys *keys, struct affine *placement)
{
    const struct item *steps = node_find(map, "transform");
    return steps ? read_steps(reader, steps, placement)
                 : read_plain(reader, at, map, keys, placement);
}
