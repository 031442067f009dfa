/* tessellate.c: shapes as closed meshes; see write.h.
 *
 * Smooth ones have normals. A plane becomes a square about its point next to the origin.
 */
#include "pov/write.h"

#include <math.h>

#define PI 3.14159265358979323846
#define COLUMNS 48

/* Two directions across a unit one. */
static void across(struct vector n, struct vector *u, struct vector *v)
{
    struct vector other = fabs(n.x) < 0.6 ? (struct vector){1, 0, 0} : (struct vector){0, 1, 0};
    *u = vector_cross(other, n);
    *u = vector_unit(*u);
    *v = vector_cross(n, *u);
}

static struct vector at(struct vector o, double a, struct vector u, double b, struct vector v)
{
    return (struct vector){o.x + a * u.x + b * v.x, o.y + a * u.y + b * v.y,
                           o.z + a * u.z + b * v.z};
}

static void put_quad(struct mesh *mesh, size_t triangle, uint32_t a, uint32_t b, uint32_t c,
                     uint32_t d)
{
    const uint32_t corners[2][3] = {{a, b, c}, {a, c, d}};
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[triangle + (size_t)t][k] = corners[t][k];
}

/* Six faces of their own corners, the front outwards. */
static bool box(const struct pov_object *o, struct mesh *mesh)
{
    if (!mesh_allocate(mesh, 24, false, false, 12))
        return false;
    const double low[3] = {fmin(o->p[0].x, o->p[1].x), fmin(o->p[0].y, o->p[1].y),
                           fmin(o->p[0].z, o->p[1].z)},
                 high[3] = {fmax(o->p[0].x, o->p[1].x), fmax(o->p[0].y, o->p[1].y),
                            fmax(o->p[0].z, o->p[1].z)};
    for (uint32_t face = 0; face < 6; face++) {
        uint32_t axis = face / 2, side = face % 2;
        for (uint32_t k = 0; k < 4; k++) {
            double p[3];
            uint32_t i = (k == 1 || k == 2), j = k >= 2;
            p[axis] = side ? high[axis] : low[axis];
            p[(axis + 1) % 3] = i ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
            p[(axis + 2) % 3] = j ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
            mesh->points[4 * face + (side ? k : 3 - k)] = (struct vector){p[0], p[1], p[2]};
        }
        put_quad(mesh, 2 * (size_t)face, 4 * face, 4 * face + 1, 4 * face + 2, 4 * face + 3);
    }
    return true;
}

static bool square(const struct pov_object *o, double extent, struct mesh *mesh)
{
    struct vector n = o->p[0], u, v, origin = vector_scale(n, o->r[0]);
    if (!mesh_allocate(mesh, 4, false, false, 2))
        return false;
    across(n, &u, &v);
    for (uint32_t k = 0; k < 4; k++)
        mesh->points[k] =
            at(origin, k == 1 || k == 2 ? extent : -extent, u, k >= 2 ? extent : -extent, v);
    put_quad(mesh, 0, 0, 1, 2, 3);
    return true;
}

static struct vector sphere_point(const void *user, double u, double v)
{
    const struct pov_object *o = user;
    double polar = PI * (1.0 - v), angle = 2.0 * PI * u, s = o->r[0] * sin(polar);
    return (struct vector){o->p[0].x + s * cos(angle), o->p[0].y + s * sin(angle),
                           o->p[0].z + o->r[0] * cos(polar)};
}

static struct vector torus_point(const void *user, double u, double v)
{
    const struct pov_object *o = user;
    double a = 2.0 * PI * u, b = 2.0 * PI * v, r = o->r[0] + o->r[1] * cos(b);
    return (struct vector){r * cos(a), -o->r[1] * sin(b), r * sin(a)};
}

/* The side, and caps with corners of their own. */
static bool cone(const struct pov_object *o, struct mesh *mesh)
{
    double radii[2] = {o->r[0], o->shape == POV_SHAPE_CYLINDER ? o->r[0] : o->r[1]};
    struct vector axis = vector_subtract(o->p[1], o->p[0]), u, v;
    double length = vector_length(axis), slope = (radii[0] - radii[1]) / length;
    struct vector n = vector_unit(axis);
    if (!mesh_allocate(mesh, 4 * COLUMNS + 2, true, false, 4 * COLUMNS))
        return false;
    across(n, &u, &v);
    mesh->points[4 * COLUMNS] = o->p[0];
    mesh->points[4 * COLUMNS + 1] = o->p[1];
    mesh->normals[4 * COLUMNS] = (struct vector){-n.x, -n.y, -n.z};
    mesh->normals[4 * COLUMNS + 1] = n;
    size_t count = 0;
    for (uint32_t i = 0; i < COLUMNS; i++) {
        double angle = 2.0 * PI * i / COLUMNS, c = cos(angle), s = sin(angle);
        uint32_t next = (i + 1) % COLUMNS;
        for (uint32_t end = 0; end < 2; end++) {
            struct vector rim = at(o->p[end], radii[end] * c, u, radii[end] * s, v);
            struct vector out =
                at((struct vector){slope * n.x, slope * n.y, slope * n.z}, c, u, s, v);
            mesh->points[end * COLUMNS + i] = mesh->points[(2 + end) * COLUMNS + i] = rim;
            mesh->normals[end * COLUMNS + i] = out;
            mesh->normals[(2 + end) * COLUMNS + i] = mesh->normals[4 * COLUMNS + end];
        }
        put_quad(mesh, count, i, next, COLUMNS + next, COLUMNS + i);
        count += 2;
        if (!o->open) {
            const uint32_t caps[2][3] = {{4 * COLUMNS, 2 * COLUMNS + next, 2 * COLUMNS + i},
                                         {4 * COLUMNS + 1, 3 * COLUMNS + i, 3 * COLUMNS + next}};
            for (int t = 0; t < 2; t++, count++)
                for (int k = 0; k < 3; k++)
                    mesh->triangles[count][k] = caps[t][k];
        }
    }
    mesh->triangle_count = count;
    return true;
}

static bool disc(const struct pov_object *o, struct mesh *mesh)
{
    struct vector n = vector_unit(o->p[1]), u, v;
    if (!mesh_allocate(mesh, 2 * COLUMNS, false, false, 2 * COLUMNS))
        return false;
    across(n, &u, &v);
    for (uint32_t i = 0; i < COLUMNS; i++) {
        double angle = 2.0 * PI * i / COLUMNS;
        uint32_t next = (i + 1) % COLUMNS;
        for (uint32_t rim = 0; rim < 2; rim++)
            mesh->points[rim * COLUMNS + i] =
                at(o->p[0], o->r[rim] * cos(angle), u, o->r[rim] * sin(angle), v);
        put_quad(mesh, 2 * (size_t)i, i, next, COLUMNS + next, COLUMNS + i);
    }
    return true;
}

bool pov_tessellate(struct pov_writer *writer, const struct pov_object *o, struct mesh *mesh)
{
    bool good;
    *mesh = (struct mesh){0};
    switch (o->shape) {
    case POV_SHAPE_BOX:
        good = box(o, mesh);
        break;
    case POV_SHAPE_PLANE:
        good = square(o, writer->extent, mesh);
        break;
    case POV_SHAPE_SPHERE:
        good = mesh_from_surface(&(struct surface_function){sphere_point, o, COLUMNS, COLUMNS / 2},
                                 mesh);
        break;
    case POV_SHAPE_TORUS:
        good = mesh_from_surface(&(struct surface_function){torus_point, o, COLUMNS, COLUMNS / 2},
                                 mesh);
        break;
    case POV_SHAPE_CYLINDER:
    case POV_SHAPE_CONE:
        good = cone(o, mesh);
        break;
    case POV_SHAPE_DISC:
        good = disc(o, mesh);
        break;
    default:
        return true;
    }
    if (!good)
        pov_no_memory(writer->reader);
    return good;
}
