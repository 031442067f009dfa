#include "scene/polygon.h"

#include <stdbool.h>
#include <string.h>

/* Twice the area of the triangle, above 0 where it turns counter-clockwise. */
static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* On its edge as well where `edge` is true. */
static bool is_within(const double p[2], const double a[2], const double b[2], const double c[2],
                      double side, bool edge)
{
    double u = side * turn(a, b, p), v = side * turn(b, c, p), w = side * turn(c, a, p);
    return edge ? u >= 0.0 && v >= 0.0 && w >= 0.0 : u > 0.0 && v > 0.0 && w > 0.0;
}

static bool is_same(const double a[2], const double b[2])
{
    return a[0] == b[0] && a[1] == b[1];
}

/* `touched`: other corners may lie on its edges. */
static bool is_ear(const double (*points)[2], const uint32_t *ring, size_t count, size_t i,
                   double side, bool touched)
{
    size_t before = (i + count - 1) % count, behind = (i + 1) % count;
    const double *a = points[ring[before]], *b = points[ring[i]], *c = points[ring[behind]];
    if (side * turn(a, b, c) <= 0.0)
        return false;
    for (size_t k = 0; k < count; k++) {
        const double *p = points[ring[k]];
        bool is_corner = k == before || k == i || k == behind || is_same(p, a) || is_same(p, c);
        if (!is_corner && is_within(p, a, b, c, side, !touched))
            return false;
    }
    return true;
}

size_t polygon_triangulate(const double (*points)[2], size_t count, uint32_t *ring,
                           uint32_t (*triangles)[3])
{
    double area = 0.0;
    size_t made = 0, i = 0, tries = 0;
    for (size_t k = 0; k < count; k++) {
        const double *a = points[k], *b = points[(k + 1) % count];
        area += a[0] * b[1] - a[1] * b[0];
        ring[k] = (uint32_t)k;
    }
    double side = area < 0.0 ? -1.0 : 1.0;
    while (count >= 3 && tries < 2 * count) {
        if (count > 3 && !is_ear(points, ring, count, i % count, side, tries >= count)) {
            i++;
            tries++;
            continue;
        }
        i %= count;
        triangles[made][0] = ring[(i + count - 1) % count];
        triangles[made][1] = ring[i];
        triangles[made++][2] = ring[(i + 1) % count];
        memmove(ring + i, ring + i + 1, (count - i - 1) * sizeof *ring);
        count--;
        tries = 0;
    }
    return made;
}
