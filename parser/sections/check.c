/* check.c: see check.h. Vectors are compared in double, where no float overflows. */
#include "parser/sections/check.h"

#include <math.h>

/* The sine below which two directions count as parallel. */
#define PARALLEL_SINE 1e-6

const struct node *check_value(const struct node *map, const struct node *at, const char *key)
{
    const struct item *item = node_find(map, key);
    return item ? item->value : at;
}

bool check_zero(ps_vec3 v)
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

bool check_up_along(ps_vec3 from, ps_vec3 to, ps_vec3 up)
{
    const double view[3] = {(double)to.x - from.x, (double)to.y - from.y, (double)to.z - from.z};
    const double upwards[3] = {up.x, up.y, up.z};
    return are_parallel(view, upwards);
}

bool check_expect(const struct reader *reader, bool good, const struct node *at,
                  const char *message)
{
    if (!good)
        reader_error(reader, at, "%s", message);
    return good;
}
