#include "scene/shape_lathe.h"

#define PI 3.14159265358979323846

struct lathe lathe_begin(struct shape *shape, ps_vec3 origin, ps_vec3 axis, size_t segments)
{
    ps_vec3 u, v;
    shape_frame(axis, &u, &v);
    return (struct lathe){
        .shape = shape,
        .origin = origin,
        .axis = axis,
        .start = ps_scale(u, -1.0f),
        .quarter = ps_scale(v, -1.0f),
        .segments = segments,
    };
}

/* Away from the axis, in half segments around. The end of a ring is exactly its start, so that the
 * seam is closed. */
static ps_vec3 direction(const struct lathe *lathe, size_t half_segments)
{
    double angle = PI * (double)(half_segments % (2 * lathe->segments)) / (double)lathe->segments;
    ps_vec3 along_start = ps_scale(lathe->start, (float)cos(angle));
    return ps_add_scaled(along_start, (float)sin(angle), lathe->quarter);
}

/* Sides and ends go through this one, so that they meet in the same points. */
static ps_vec3 position(const struct lathe *lathe, float radius, float height, ps_vec3 away)
{
    return ps_add_scaled(ps_add_scaled(lathe->origin, height, lathe->axis), radius, away);
}

static void add_vertex(struct lathe *lathe, ps_vec3 vertex, ps_vec3 normal, float u, float v)
{
    struct shape *shape = lathe->shape;
    shape->vertices[lathe->vertices] = vertex;
    shape->normals[lathe->vertices] = normal;
    shape->uv[lathe->vertices][0] = u;
    shape->uv[lathe->vertices][1] = v;
    lathe->vertices++;
}

static void add_triangle(struct lathe *lathe, size_t a, size_t b, size_t c)
{
    uint32_t *triangle = lathe->shape->triangles[lathe->triangles++];
    triangle[0] = (uint32_t)a;
    triangle[1] = (uint32_t)b;
    triangle[2] = (uint32_t)c;
}

/* The point on the axis has a vertex in the middle of each segment: its u and normal differ. */
void lathe_ring(struct lathe *lathe, const struct profile_point *point)
{
    size_t count = lathe_ring_vertices(lathe->segments, point->radius);
    lathe->ring = lathe->vertices;
    lathe->ring_is_pole = count == lathe->segments;
    for (size_t i = 0; i < count; i++) {
        size_t half_segments = 2 * i + (lathe->ring_is_pole ? 1 : 0);
        ps_vec3 away = direction(lathe, half_segments);
        ps_vec3 normal = ps_scale(away, point->normal_radius);
        add_vertex(lathe, position(lathe, point->radius, point->height, away),
                   ps_add_scaled(normal, point->normal_height, lathe->axis),
                   (float)half_segments / (float)(2 * lathe->segments), point->v);
    }
}

void lathe_join(struct lathe *lathe, const struct profile_point *point)
{
    size_t below = lathe->ring;
    bool below_is_pole = lathe->ring_is_pole;
    lathe_ring(lathe, point);
    for (size_t i = 0; i < lathe->segments; i++) {
        size_t above = lathe->ring;
        if (!below_is_pole)
            add_triangle(lathe, below + i, below + i + 1, above + i + !lathe->ring_is_pole);
        if (!lathe->ring_is_pole)
            add_triangle(lathe, below + i, above + i + 1, above + i);
    }
}

/* The square around the disc along the frame of its normal is the picture. */
static void add_disc_vertex(struct lathe *lathe, ps_vec3 normal, float height, ps_vec3 offset,
                            float radius)
{
    ps_vec3 u, v;
    shape_frame(normal, &u, &v);
    add_vertex(lathe, position(lathe, 1.0f, height, offset), normal,
               0.5f + 0.5f * ps_dot(offset, u) / radius, 0.5f + 0.5f * ps_dot(offset, v) / radius);
}

/* Counter-clockwise as seen from where the axis points, or the other way around. */
static void add_disc_triangle(struct lathe *lathe, size_t a, size_t b, size_t c, bool along_axis)
{
    add_triangle(lathe, a, along_axis ? b : c, along_axis ? c : b);
}

static void add_disc_ring(struct lathe *lathe, ps_vec3 normal, float height, float ring,
                          float radius)
{
    for (size_t i = 0; i < lathe->segments; i++)
        add_disc_vertex(lathe, normal, height, ps_scale(direction(lathe, 2 * i), ring), radius);
}

void lathe_disc(struct lathe *lathe, float height, float radius, float hole, bool along_axis)
{
    ps_vec3 normal = ps_scale(lathe->axis, along_axis ? 1.0f : -1.0f);
    size_t n = lathe->segments, rim = lathe->vertices, inner = rim + n;
    add_disc_ring(lathe, normal, height, radius, radius);
    if (hole > 0.0f)
        add_disc_ring(lathe, normal, height, hole, radius);
    else
        add_disc_vertex(lathe, normal, height, (ps_vec3){0, 0, 0}, radius);
    for (size_t i = 0; i < n; i++) {
        size_t next = (i + 1) % n;
        if (hole > 0.0f) {
            add_disc_triangle(lathe, inner + i, rim + i, rim + next, along_axis);
            add_disc_triangle(lathe, inner + i, rim + next, inner + next, along_axis);
        } else {
            add_disc_triangle(lathe, inner, rim + i, rim + next, along_axis);
        }
    }
}
