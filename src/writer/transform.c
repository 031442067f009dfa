/* transform.c: see transform.h. */
#include "writer/transform.h"

#include <math.h>

#define PI 3.14159265358979323846

const struct transform transform_identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/* False where there is no direction. */
static bool normalize(struct vector *a)
{
    double length = vector_length(*a);
    if (!(length > 0.0) || !isfinite(length))
        return false;
    *a = (struct vector){a->x / length, a->y / length, a->z / length};
    return true;
}

struct transform transform_compose(const struct transform *outer, const struct transform *inner)
{
    struct transform product;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            product.m[i][j] = j == 3 ? outer->m[i][3] : 0.0;
            for (int k = 0; k < 3; k++)
                product.m[i][j] += outer->m[i][k] * inner->m[k][j];
        }
    return product;
}

struct transform transform_translate(double x, double y, double z)
{
    return (struct transform){{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}}};
}

struct transform transform_scale(double x, double y, double z)
{
    return (struct transform){{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}};
}

/* Rodrigues' formula. */
bool transform_rotate(double degrees, struct vector axis, struct transform *result)
{
    if (!normalize(&axis))
        return false;
    double s = sin(degrees * PI / 180.0), c = cos(degrees * PI / 180.0);
    if (fmod(degrees, 90.0) == 0.0) { /* exact, as such turns are common */
        s = round(s);
        c = round(c);
    }
    double d = 1.0 - c;
    double x = axis.x, y = axis.y, z = axis.z;
    *result = (struct transform){{{x * x * d + c, x * y * d - z * s, x * z * d + y * s, 0},
                                  {y * x * d + z * s, y * y * d + c, y * z * d - x * s, 0},
                                  {z * x * d - y * s, z * y * d + x * s, z * z * d + c, 0}}};
    return true;
}

bool transform_look_at(struct vector eye, struct vector look, struct vector up,
                       struct transform *result)
{
    struct vector z = vector_subtract(look, eye);
    if (!normalize(&z) || !normalize(&up))
        return false;
    struct vector x = vector_cross(up, z);
    if (vector_length(x) < 1e-9 || !normalize(&x))
        return false;
    struct vector y = vector_cross(z, x);
    *result = (struct transform){{{x.x, x.y, x.z, -vector_dot(x, eye)},
                                  {y.x, y.y, y.z, -vector_dot(y, eye)},
                                  {z.x, z.y, z.z, -vector_dot(z, eye)}}};
    return true;
}

bool transform_from_columns(const double numbers[16], struct transform *result)
{
    double w = numbers[15];
    if (numbers[3] != 0.0 || numbers[7] != 0.0 || numbers[11] != 0.0 || w == 0.0)
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            result->m[i][j] = numbers[4 * j + i] / w;
    return true;
}

static struct vector column(const struct transform *map, int j)
{
    return (struct vector){map->m[0][j], map->m[1][j], map->m[2][j]};
}

double transform_determinant(const struct transform *map)
{
    return vector_dot(column(map, 0), vector_cross(column(map, 1), column(map, 2)));
}

bool transform_invert(const struct transform *map, struct transform *inverse)
{
    double determinant = transform_determinant(map);
    if (!(fabs(determinant) > 0.0) || !isfinite(determinant) || !isfinite(1.0 / determinant))
        return false;
    for (int i = 0; i < 3; i++) {
        struct vector row = vector_cross(column(map, (i + 1) % 3), column(map, (i + 2) % 3));
        inverse->m[i][0] = row.x / determinant;
        inverse->m[i][1] = row.y / determinant;
        inverse->m[i][2] = row.z / determinant;
        inverse->m[i][3] = -vector_dot(row, column(map, 3)) / determinant;
    }
    return true;
}

struct vector transform_direction(const struct transform *map, struct vector d)
{
    return (struct vector){
        map->m[0][0] * d.x + map->m[0][1] * d.y + map->m[0][2] * d.z,
        map->m[1][0] * d.x + map->m[1][1] * d.y + map->m[1][2] * d.z,
        map->m[2][0] * d.x + map->m[2][1] * d.y + map->m[2][2] * d.z,
    };
}

struct vector transform_point(const struct transform *map, struct vector p)
{
    struct vector d = transform_direction(map, p);
    return (struct vector){d.x + map->m[0][3], d.y + map->m[1][3], d.z + map->m[2][3]};
}

/* The cofactor matrix, turned back where the map mirrors. */
struct vector transform_normal(const struct transform *map, struct vector n)
{
    struct vector x = column(map, 0), y = column(map, 1), z = column(map, 2);
    struct vector a = vector_cross(y, z), b = vector_cross(z, x), c = vector_cross(x, y);
    double side = transform_determinant(map) < 0.0 ? -1.0 : 1.0;
    return (struct vector){side * (a.x * n.x + b.x * n.y + c.x * n.z),
                           side * (a.y * n.x + b.y * n.y + c.y * n.z),
                           side * (a.z * n.x + b.z * n.y + c.z * n.z)};
}
