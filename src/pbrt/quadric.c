/* quadric.c: pbrt's quadrics (Pharr, Jakob and Humphreys, "Physically based rendering", on
 * quadrics).
 *
 * Whole ones are psplat's own shapes, parts of them meshes. All turn about z; u runs with the angle
 * from x towards y, v along z or, of discs, inwards. psplat's spheres have their poles on y, and
 * its u starts at -x.
 */
#include "pbrt/shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define COLUMNS 64
#define ROWS 32

struct quadric {
    double radius, hole;       /* hole: of a disc */
    double low, high;          /* z, or the polar angles of a sphere, at v = 0 and 1 */
    double turn;               /* phimax, in radians */
    struct vector first, last; /* of a hyperboloid */
};

static struct vector turned(double radius, double z, double angle)
{
    return (struct vector){radius * cos(angle), radius * sin(angle), z};
}

static double between(double a, double b, double share)
{
    return a + (b - a) * share;
}

static struct vector sphere_point(const void *user, double u, double v)
{
    const struct quadric *q = user;
    double theta = between(q->low, q->high, v);
    return turned(q->radius * sin(theta), q->radius * cos(theta), u * q->turn);
}

static struct vector cylinder_point(const void *user, double u, double v)
{
    const struct quadric *q = user;
    return turned(q->radius, between(q->low, q->high, v), u * q->turn);
}

static struct vector disk_point(const void *user, double u, double v)
{
    const struct quadric *q = user;
    return turned(between(q->radius, q->hole, v), q->low, u * q->turn);
}

static struct vector cone_point(const void *user, double u, double v)
{
    const struct quadric *q = user;
    return turned(q->radius * (1.0 - v), v * q->high, u * q->turn);
}

/* z = zmax (x^2 + y^2) / radius^2; `first` holds zmax. */
static struct vector paraboloid_point(const void *user, double u, double v)
{
    const struct quadric *q = user;
    double z = between(q->low, q->high, v);
    return turned(q->radius * sqrt(fmax(z / q->first.z, 0.0)), z, u * q->turn);
}

static struct vector hyperboloid_point(const void *user, double u, double v)
{
    const struct quadric *q = user;
    double x = between(q->first.x, q->last.x, v), y = between(q->first.y, q->last.y, v);
    double c = cos(u * q->turn), s = sin(u * q->turn);
    return (struct vector){x * c - y * s, x * s + y * c, between(q->first.z, q->last.z, v)};
}

/* --- psplat's own shapes
 * ---------------------------------------------------------------------------- */

/* pbrt's x, y, z of psplat's: the pole from y to z, and u = 0 from -x to x. */
static const struct transform sphere_frame = {{{-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}}};
static const struct transform axis_frame = {{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}}};

static void put_sphere(FILE *out, const struct quadric *q)
{
    fputs("  - sphere: {center: [0, 0, 0], radius: ", out);
    put_number(out, q->radius);
}

static void put_cylinder(FILE *out, const struct quadric *q)
{
    fputs("  - cylinder: {from: ", out);
    put_vector(out, (struct vector){0, 0, q->low});
    fputs(", to: ", out);
    put_vector(out, (struct vector){0, 0, q->high});
    fputs(", radius: ", out);
    put_number(out, q->radius);
    fputs(", open: yes", out);
}

static void put_cone(FILE *out, const struct quadric *q)
{
    fputs("  - cone: {from: [0, 0, 0], from_radius: ", out);
    put_number(out, q->radius);
    fputs(", to: ", out);
    put_vector(out, (struct vector){0, 0, q->high});
    fputs(", to_radius: 0, open: yes", out);
}

static void put_disk(FILE *out, const struct quadric *q)
{
    fputs("  - disc: {center: ", out);
    put_vector(out, (struct vector){0, 0, q->low});
    fputs(", normal: [0, 0, 1], radius: ", out);
    put_number(out, q->radius);
    if (q->hole > 0.0) {
        fputs(", hole: ", out);
        put_number(out, q->hole);
    }
}

/* --- reading
 * ---------------------------------------------------------------------------------------- */

/* The polar angles of zmin and zmax. */
static bool read_sphere(struct importer *importer, const struct statement *statement,
                        struct quadric *q)
{
    double r = q->radius;
    double low = fmin(fmax(statement_number(importer, statement, "zmin", -r), -r), r);
    double high = fmin(fmax(statement_number(importer, statement, "zmax", r), -r), r);
    q->low = acos(fmin(low, high) / r);
    q->high = acos(fmax(low, high) / r);
    return q->low == acos(-1.0) && q->high == 0.0;
}

static bool read_cylinder(struct importer *importer, const struct statement *statement,
                          struct quadric *q)
{
    double a = statement_number(importer, statement, "zmin", -1.0),
           b = statement_number(importer, statement, "zmax", 1.0);
    q->low = fmin(a, b);
    q->high = fmax(a, b);
    return true;
}

static bool read_cone(struct importer *importer, const struct statement *statement,
                      struct quadric *q)
{
    q->high = statement_number(importer, statement, "height", 1.0);
    return q->high > 0.0;
}

static bool read_disk(struct importer *importer, const struct statement *statement,
                      struct quadric *q)
{
    q->low = statement_number(importer, statement, "height", 0.0);
    q->high = q->low + fabs(q->low) + 1.0; /* flat: not looked at */
    q->hole = fmax(statement_number(importer, statement, "innerradius", 0.0), 0.0);
    return q->hole < (double)(float)q->radius && (float)q->hole < (float)q->radius;
}

static bool read_paraboloid(struct importer *importer, const struct statement *statement,
                            struct quadric *q)
{
    double a = statement_number(importer, statement, "zmin", 0.0),
           b = statement_number(importer, statement, "zmax", 1.0);
    q->low = fmin(a, b);
    q->high = q->first.z = fmax(a, b);
    return false;
}

static bool read_hyperboloid(struct importer *importer, const struct statement *statement,
                             struct quadric *q)
{
    q->first = statement_vector(importer, statement, "p1", (struct vector){0, 0, 0});
    q->last = statement_vector(importer, statement, "p2", (struct vector){1, 1, 1});
    q->high = vector_length(vector_subtract(q->last, q->first));
    return false;
}

static const struct kind {
    const char *name;
    struct vector (*point)(const void *user, double u, double v);
    /* Reads all but radius and phimax; true: psplat has the shape, where it goes all around. */
    bool (*read)(struct importer *importer, const struct statement *statement, struct quadric *q);
    void (*put)(FILE *out, const struct quadric *q);
    const struct transform *frame; /* psplat's shape to pbrt's */
    size_t rows;
} kinds[] = {
    {"sphere", sphere_point, read_sphere, put_sphere, &sphere_frame, ROWS},
    {"cylinder", cylinder_point, read_cylinder, put_cylinder, &axis_frame, 1},
    {"cone", cone_point, read_cone, put_cone, &axis_frame, 1},
    {"disk", disk_point, read_disk, put_disk, &axis_frame, 1},
    {"paraboloid", paraboloid_point, read_paraboloid, NULL, NULL, ROWS},
    {"hyperboloid", hyperboloid_point, read_hyperboloid, NULL, NULL, ROWS},
};

/* As an object of psplat's; false: that can't say what is wanted, that its back is its front, or
 * holes of a sphere that shines. */
static bool add_own(struct importer *importer, const struct statement *statement,
                    const struct kind *kind, const struct quadric *q, double area)
{
    struct transform placement;
    if (!importer_placement(importer, &importer->state.ctm, &statement->origin, statement->width,
                            &placement))
        return true;
    struct surface surface = material_surface(importer, statement, area);
    if (!surface.material)
        return true;
    if ((importer->state.reverse && surface.one_sided) ||
        (importer->state.area_light && surface.has_holes && kind->point == sphere_point))
        return false;
    placement = transform_compose(&placement, kind->frame);
    kind->put(importer_objects(importer), q);
    surface_finish(importer, importer_objects(importer), &surface, &placement);
    return true;
}

static void add(struct importer *importer, const struct statement *statement,
                const struct kind *kind)
{
    double phimax = statement_number(importer, statement, "phimax", 360.0);
    struct quadric q = {.radius = statement_number(importer, statement, "radius", 1.0)};
    bool is_whole = q.radius > 0.0 && phimax >= 360.0;
    struct mesh mesh = {0};
    q.turn = fmin(phimax, 360.0) * PI / 180.0;
    if (!((float)q.radius > 0.0f) || !(q.turn > 0.0)) {
        importer_error(importer, &statement->origin, statement->width,
                       "Shape %s: radius and phimax must be above 0, as floats are", kind->name);
        return;
    }
    is_whole = kind->read(importer, statement, &q) && is_whole;
    if ((float)q.low == (float)q.high || (kind->point == paraboloid_point && !(q.high > 0.0))) {
        importer_error(importer, &statement->origin, statement->width, "Shape %s: it has no extent",
                       kind->name);
        return;
    }
    if (is_whole && !importer->state.area_light && add_own(importer, statement, kind, &q, 0.0))
        return;
    const struct surface_function surface = {kind->point, &q, COLUMNS, kind->rows};
    if (!mesh_from_surface(&surface, &mesh)) {
        importer_report_memory(importer);
        return;
    }
    double area = mesh_area(&mesh, &importer->state.ctm);
    if (!is_whole || !importer->state.area_light || !add_own(importer, statement, kind, &q, area))
        mesh_add(importer, statement, &mesh);
    mesh_release(&mesh);
}

bool quadric_add(struct importer *importer, const struct statement *statement)
{
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(statement->kind, kinds[i].name) == 0) {
            add(importer, statement, &kinds[i]);
            return true;
        }
    return false;
}
