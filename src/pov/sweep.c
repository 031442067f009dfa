/* sweep.c: reads what is made of curves: lathe, sor, prism, polygon; see object.h.
 *
 * The splines are those of the reference of POV-Ray 3.7, "Lathe" and "Prism": quadratic ones have
 * one point before the first, cubic ones (Catmull-Rom) one before and one behind, Bezier curves
 * four points for each piece.
 */
#include "pov/expression.h"
#include "pov/surface.h"
#include "scene/polygon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define MOST_POINTS 4096
#define PIECES 12  /* of a curve between two points */
#define COLUMNS 64 /* around */

/* Points of a curve; lists of their own. */
struct curve {
    double (*points)[2];
    size_t count, capacity;
    bool is_smooth;
};

static void add_point(struct pov_reader *reader, struct curve *curve, double x, double y)
{
    if (!pov_grow(reader, (void **)&curve->points, &curve->capacity, curve->count + 1,
                  sizeof *curve->points))
        return;
    curve->points[curve->count][0] = x;
    curve->points[curve->count++][1] = y;
}

/* "N, <x, y>, ..." */
static struct curve read_points(struct pov_reader *reader)
{
    struct curve curve = {0};
    double count = pov_read_float(reader);
    pov_skip_comma(reader);
    if (!(count >= 1.0 && count <= MOST_POINTS)) {
        pov_error(reader, pov_peek(reader), "expected 1 to %d points", MOST_POINTS);
        return curve;
    }
    for (size_t i = 0; i < (size_t)count && !reader->stopped; i++) {
        struct vector a = pov_read_vector(reader);
        add_point(reader, &curve, a.x, a.y);
        pov_skip_comma(reader);
    }
    return curve;
}

/* Of four points (two, three or four count), the curve's value from the second to the third. */
static double blend(uint32_t kind, const double p[4], double t)
{
    double s = 1.0 - t;
    switch (kind) {
    case POV_quadratic_spline:
        return ((0.5 * p[0] - p[1] + 0.5 * p[2]) * t + 0.5 * (p[2] - p[0])) * t + p[1];
    case POV_cubic_spline:
        return (((-0.5 * p[0] + 1.5 * p[1] - 1.5 * p[2] + 0.5 * p[3]) * t + p[0] - 2.5 * p[1] +
                 2.0 * p[2] - 0.5 * p[3]) *
                    t +
                0.5 * (p[2] - p[0])) *
                   t +
               p[1];
    case POV_bezier_spline:
        return s * s * s * p[0] + 3.0 * s * s * t * p[1] + 3.0 * s * t * t * p[2] +
               t * t * t * p[3];
    default:
        return s * p[1] + t * p[2];
    }
}

/* The points on the way, of a spline's control points. */
static struct curve trace(struct pov_reader *reader, uint32_t kind, const struct curve *control)
{
    struct curve curve = {.is_smooth = kind != POV_linear_spline};
    size_t before = kind == POV_quadratic_spline || kind == POV_cubic_spline ? 1 : 0;
    size_t behind = kind == POV_cubic_spline ? 2 : 1, step = kind == POV_bezier_spline ? 4 : 1;
    size_t pieces = kind == POV_linear_spline ? 1 : PIECES, last = control->count;
    if (kind == POV_bezier_spline)
        behind = 3;
    for (size_t i = before; i + behind < last; i += step)
        for (size_t k = 0; k <= pieces; k++) {
            double x[4], y[4], t = (double)k / (double)pieces;
            for (size_t j = 0; j < 4; j++) {
                size_t at = kind == POV_bezier_spline ? i + j : i + j - 1;
                at = at >= last ? i : at; /* before the first, or behind the last: does not count */
                x[j] = control->points[at][0];
                y[j] = control->points[at][1];
            }
            double px = blend(kind, x, t), py = blend(kind, y, t);
            const double *end = curve.count > 0 ? curve.points[curve.count - 1] : NULL;
            if (!end || fabs(end[0] - px) + fabs(end[1] - py) > 1e-9)
                add_point(reader, &curve, px, py);
        }
    return curve;
}

static uint32_t read_kind(struct pov_reader *reader, uint32_t usual)
{
    struct pov_token token = pov_next(reader);
    if (pov_is_word(&token, POV_linear_spline) || pov_is_word(&token, POV_quadratic_spline) ||
        pov_is_word(&token, POV_cubic_spline) || pov_is_word(&token, POV_bezier_spline))
        return token.word;
    pov_unread(reader, token);
    return usual;
}

/* --- around the y axis
 * -------------------------------------------------------------------------------- */

/* The direction across the curve at one end of a piece; of smooth curves the mean with the
 * neighbour's. */
static void across(const struct curve *curve, size_t piece, size_t end, double normal[2])
{
    size_t last = curve->count - 2, from = piece, to = piece;
    if (curve->is_smooth && end == 0 && piece > 0)
        from--;
    if (curve->is_smooth && end == 1 && piece < last)
        to++;
    normal[0] = curve->points[to + 1][1] - curve->points[from][1];
    normal[1] = curve->points[from][0] - curve->points[to + 1][0];
}

static struct pov_corner around(const struct curve *curve, size_t piece, size_t end, size_t column)
{
    double angle = 2.0 * PI * (double)column / COLUMNS, c = cos(angle), s = sin(angle), n[2];
    const double *p = curve->points[piece + end];
    across(curve, piece, end, n);
    return (struct pov_corner){
        {p[0] * c, p[1], p[0] * s},
        {n[0] * c, n[1], n[0] * s},
        {(double)column / COLUMNS, (double)(piece + end) / (double)(curve->count - 1)}};
}

static void revolve(struct pov_reader *reader, const struct curve *curve, struct pov_object *object)
{
    struct pov_surface surface = {.reader = reader, .has_normals = true, .has_uv = true};
    for (size_t i = 0; i + 1 < curve->count; i++)
        for (size_t column = 0; column < COLUMNS; column++) {
            const struct pov_corner a = around(curve, i, 0, column),
                                    b = around(curve, i, 0, column + 1),
                                    c = around(curve, i, 1, column + 1),
                                    d = around(curve, i, 1, column);
            pov_surface_triangle(&surface, (const struct pov_corner[3]){a, b, c});
            pov_surface_triangle(&surface, (const struct pov_corner[3]){a, c, d});
        }
    pov_surface_finish(&surface, object);
}

void pov_read_lathe(struct pov_reader *reader, struct pov_object *object)
{
    uint32_t kind = read_kind(reader, POV_linear_spline);
    struct curve control = read_points(reader), curve = trace(reader, kind, &control);
    revolve(reader, &curve, object);
    free(control.points);
    free(curve.points);
}

/* The square of the radius is a cubic of the height, by the slopes of the neighbours. */
void pov_read_sor(struct pov_reader *reader, struct pov_object *object)
{
    struct curve control = read_points(reader), curve = {.is_smooth = true};
    double(*p)[2] = control.points;
    for (size_t i = 1; i + 2 < control.count && !reader->stopped; i++)
        for (size_t k = 0; k <= PIECES; k++) {
            double t = (double)k / PIECES, height = p[i + 1][1] - p[i][1];
            double r0 = p[i][0] * p[i][0], r1 = p[i + 1][0] * p[i + 1][0];
            double before = p[i + 1][1] - p[i - 1][1], behind = p[i + 2][1] - p[i][1];
            double s0 = before != 0.0 ? 2.0 * p[i][0] * (p[i + 1][0] - p[i - 1][0]) / before : 0.0;
            double s1 = behind != 0.0 ? 2.0 * p[i + 1][0] * (p[i + 2][0] - p[i][0]) / behind : 0.0;
            double h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t);
            double h01 = t * t * (3 - 2 * t), h11 = t * t * (t - 1);
            double square = h00 * r0 + h01 * r1 + height * (h10 * s0 + h11 * s1);
            if (k > 0 || i == 1)
                add_point(reader, &curve, sqrt(fmax(square, 0.0)), p[i][1] + t * height);
        }
    if (!pov_accept_word(reader, POV_open) && curve.count > 0 && !reader->stopped) {
        struct curve closed = {0}; /* caps, with edges */
        const double *first = curve.points[0], *last = curve.points[curve.count - 1];
        struct pov_object *whole = object;
        add_point(reader, &closed, 0.0, first[1]);
        for (size_t i = 0; i < curve.count; i++)
            add_point(reader, &closed, curve.points[i][0], curve.points[i][1]);
        add_point(reader, &closed, 0.0, last[1]);
        revolve(reader, &closed, whole);
        free(closed.points);
    } else {
        revolve(reader, &curve, object);
    }
    free(control.points);
    free(curve.points);
}

/* --- along the y axis
 * --------------------------------------------------------------------------------- */

struct sweep {
    double heights[2], scales[2]; /* scales: of the outline there */
    bool open;
};

static struct pov_corner swept(const struct sweep *sweep, const double point[2], int end)
{
    double scale = sweep->scales[end];
    return (struct pov_corner){.point = {scale * point[0], sweep->heights[end], scale * point[1]}};
}

/* Walls and caps of one closed outline, whose first point is not repeated. */
static void add_outline(struct pov_surface *surface, const struct sweep *sweep,
                        const double (*points)[2], size_t count)
{
    uint32_t(*triangles)[3] = malloc((count + 1) * sizeof *triangles);
    uint32_t *ring = malloc((count + 1) * sizeof *ring);
    if (!triangles || !ring) {
        pov_no_memory(surface->reader);
        free(triangles);
        free(ring);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const double *p = points[i], *q = points[(i + 1) % count];
        const struct pov_corner a = swept(sweep, p, 0), b = swept(sweep, q, 0),
                                c = swept(sweep, q, 1), d = swept(sweep, p, 1);
        pov_surface_triangle(surface, (const struct pov_corner[3]){a, b, c});
        pov_surface_triangle(surface, (const struct pov_corner[3]){a, c, d});
    }
    size_t made = sweep->open ? 0 : polygon_triangulate(points, count, ring, triangles);
    for (int end = 0; end < 2; end++)
        for (size_t i = 0; i < made; i++) {
            struct pov_corner corners[3];
            for (int k = 0; k < 3; k++)
                corners[k] = swept(sweep, points[triangles[i][end ? 2 - k : k]], end);
            pov_surface_triangle(surface, corners);
        }
    free(triangles);
    free(ring);
}

static bool is_same(const double a[2], const double b[2])
{
    return fabs(a[0] - b[0]) + fabs(a[1] - b[1]) < 1e-9;
}

/* Outlines are closed where the first point comes again; returns how many there were. */
static int add_outlines(struct pov_surface *surface, const struct sweep *sweep, uint32_t kind,
                        const struct curve *control)
{
    int outlines = 0;
    size_t before = kind == POV_quadratic_spline || kind == POV_cubic_spline ? 1 : 0;
    for (size_t start = 0; start + before < control->count && !surface->reader->stopped;) {
        size_t end = start + before + 1;
        while (end < control->count &&
               (kind == POV_bezier_spline ||
                !is_same(control->points[end], control->points[start + before])))
            end++;
        size_t used = end + (kind == POV_cubic_spline ? 2 : 1);
        used = used < control->count ? used : control->count;
        const struct curve part = {.points = control->points + start, .count = used - start};
        struct curve curve = trace(surface->reader, kind, &part);
        if (curve.count > 1 && is_same(curve.points[0], curve.points[curve.count - 1]))
            curve.count--;
        add_outline(surface, sweep, (const double(*)[2])curve.points, curve.count);
        free(curve.points);
        outlines++;
        start = used;
    }
    return outlines;
}

void pov_read_prism(struct pov_reader *reader, struct pov_object *object)
{
    bool is_conic = false;
    for (struct pov_token token = pov_next(reader);; token = pov_next(reader)) {
        is_conic = is_conic || pov_is_word(&token, POV_conic_sweep);
        if (!pov_is_word(&token, POV_conic_sweep) && !pov_is_word(&token, POV_linear_sweep)) {
            pov_unread(reader, token);
            break;
        }
    }
    uint32_t kind = read_kind(reader, POV_linear_spline);
    if (pov_accept_word(reader, POV_conic_sweep))
        is_conic = true;
    else
        pov_accept_word(reader, POV_linear_sweep);
    struct sweep sweep = {.scales = {1.0, 1.0}};
    for (int i = 0; i < 2; i++) {
        sweep.heights[i] = pov_read_float(reader);
        sweep.scales[i] = is_conic ? sweep.heights[i] : 1.0;
        pov_skip_comma(reader);
    }
    struct curve control = read_points(reader);
    struct pov_surface surface = {.reader = reader};
    sweep.open = pov_accept_word(reader, POV_open);
    if (add_outlines(&surface, &sweep, kind, &control) > 1)
        pov_warn(reader, &object->token,
                 "prism: of several outlines each becomes a solid; inner ones cut no holes");
    pov_surface_finish(&surface, object);
    free(control.points);
}

/* --- polygons
 * ----------------------------------------------------------------------------------------- */

/* Two axes of the plane that the points lie in. False: they lie on a line. */
static bool plane_of(const struct vector *points, size_t count, struct vector axes[2])
{
    struct vector normal = {0, 0, 0};
    for (size_t i = 1; i + 1 < count; i++) {
        struct vector n = vector_cross(vector_subtract(points[i], points[0]),
                                       vector_subtract(points[i + 1], points[0]));
        normal = vector_length(n) > vector_length(normal) ? n : normal;
    }
    double length = vector_length(normal);
    if (!(length > 0.0))
        return false;
    normal = vector_unit(normal);
    struct vector other =
        fabs(normal.x) < 0.6 ? (struct vector){1, 0, 0} : (struct vector){0, 1, 0};
    axes[0] = vector_cross(other, normal);
    axes[1] = vector_cross(normal, axes[0]);
    return true;
}

static void add_polygon(struct pov_surface *surface, const struct vector *points, size_t count)
{
    struct vector axes[2];
    double(*flat)[2] = malloc((count + 1) * sizeof *flat);
    uint32_t(*triangles)[3] = malloc((count + 1) * sizeof *triangles);
    uint32_t *ring = malloc((count + 1) * sizeof *ring);
    if (!flat || !triangles || !ring) {
        pov_no_memory(surface->reader);
    } else if (plane_of(points, count, axes)) {
        for (size_t i = 0; i < count; i++) {
            flat[i][0] = vector_dot(points[i], axes[0]);
            flat[i][1] = vector_dot(points[i], axes[1]);
        }
        size_t made = polygon_triangulate((const double(*)[2])flat, count, ring, triangles);
        for (size_t i = 0; i < made; i++) {
            struct pov_corner corners[3];
            for (int k = 0; k < 3; k++)
                corners[k] = (struct pov_corner){.point = points[triangles[i][k]]};
            pov_surface_triangle(surface, corners);
        }
    }
    free(flat);
    free(triangles);
    free(ring);
}

void pov_read_polygon(struct pov_reader *reader, struct pov_object *object)
{
    struct pov_surface surface = {.reader = reader};
    struct vector *points = NULL;
    size_t count = 0, capacity = 0;
    int outlines = 0;
    double wanted = pov_read_float(reader);
    if (!(wanted >= 3.0 && wanted <= MOST_POINTS))
        pov_error(reader, &object->token, "polygon: expected 3 to %d points", MOST_POINTS);
    pov_skip_comma(reader);
    for (size_t i = 0; i < (size_t)fmax(wanted, 0.0) && !reader->stopped; i++) {
        struct vector point = pov_read_vector(reader);
        pov_skip_comma(reader);
        bool closes = count > 2 && vector_length(vector_subtract(point, points[0])) < 1e-9;
        if (!closes) {
            if (!pov_grow(reader, (void **)&points, &capacity, count + 1, sizeof *points))
                break;
            points[count++] = point;
        }
        if ((closes || i + 1 == (size_t)wanted) && count > 2) {
            add_polygon(&surface, points, count);
            outlines++;
            count = 0;
        }
    }
    if (outlines > 1)
        pov_warn(reader, &object->token, "polygon: inner outlines cut no holes");
    free(points);
    pov_surface_finish(&surface, object);
}

/* --- surfaces by two parameters
 * ------------------------------------------------------------------------- */

static double signed_power(double base, double exponent)
{
    return copysign(pow(fabs(base), exponent), base);
}

struct point2 {
    double x, y;
};

/* |x|^(2/e) + |y|^(2/e) = 1. The usual parameter, x = cos^e and y = sin^e, leaves the sides of
 * near-squares without points and never comes to the middle of a side, as cos(pi / 2) is no 0; so
 * these go by the angle at the centre. It in turn would leave the points of stars without any. */
static struct point2 superellipse(double angle, double e)
{
    double c = cos(angle), s = sin(angle);
    if (e >= 1.0)
        return (struct point2){signed_power(c, e), signed_power(s, e)};
    double radius = pow(pow(fabs(c), 2.0 / e) + pow(fabs(s), 2.0 / e), -0.5 * e);
    return (struct point2){radius * c, radius * s};
}

/* |x|^(2/e) + |y|^(2/e), to the power of e/n, and |z|^(2/n) sum to 1. */
static struct vector superellipsoid_point(const void *user, double u, double v)
{
    const double *exponents = user;
    struct point2 around = superellipse(2.0 * PI * u, exponents[0]);
    struct point2 up = superellipse(PI * (v - 0.5), exponents[1]);
    return (struct vector){up.x * around.x, up.x * around.y, up.y};
}

static void add_surface(struct pov_reader *reader, struct pov_object *object,
                        const struct surface_function *surface)
{
    struct mesh mesh;
    if (!mesh_from_surface(surface, &mesh)) {
        pov_no_memory(reader);
        return;
    }
    for (size_t i = 0; i < mesh.vertex_count && mesh.normals; i++)
        if (!(vector_length(mesh.normals[i]) > 1e-9)) { /* an edge: flat triangles */
            free(mesh.normals);
            mesh.normals = NULL;
        }
    pov_surface_adopt(reader, &mesh, object);
}

void pov_read_superellipsoid(struct pov_reader *reader, struct pov_object *object)
{
    struct vector e = pov_read_vector(reader);
    const double exponents[2] = {fmin(fmax(e.x, 0.01), 10.0), fmin(fmax(e.y, 0.01), 10.0)};
    const struct surface_function surface = {superellipsoid_point, exponents, 128, 64};
    add_surface(reader, object, &surface);
}

static struct vector bezier(const struct vector p[4], double t)
{
    double x[4] = {p[0].x, p[1].x, p[2].x, p[3].x}, y[4] = {p[0].y, p[1].y, p[2].y, p[3].y},
           z[4] = {p[0].z, p[1].z, p[2].z, p[3].z};
    return (struct vector){blend(POV_bezier_spline, x, t), blend(POV_bezier_spline, y, t),
                           blend(POV_bezier_spline, z, t)};
}

static struct vector patch_point(const void *user, double u, double v)
{
    const struct vector *points = user;
    struct vector rows[4];
    for (int i = 0; i < 4; i++)
        rows[i] = bezier(points + 4 * i, u);
    return bezier(rows, v);
}

void pov_read_bicubic_patch(struct pov_reader *reader, struct pov_object *object)
{
    struct vector points[16];
    struct pov_token token;
    while (token = pov_next(reader),
           pov_is_word(&token, POV_type) || pov_is_word(&token, POV_flatness) ||
               pov_is_word(&token, POV_u_steps) || pov_is_word(&token, POV_v_steps)) {
        pov_read_float(reader);
        pov_skip_comma(reader);
    }
    pov_unread(reader, token);
    for (int i = 0; i < 16; i++) {
        points[i] = pov_read_vector(reader);
        pov_skip_comma(reader);
    }
    const struct surface_function surface = {patch_point, points, 16, 16};
    if (!reader->stopped)
        add_surface(reader, object, &surface);
}
