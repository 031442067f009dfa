#include "support/mesh_facts.h"

#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct shape_surroundings nothing;

static void complete(struct object_description *object)
{
    if (affine_determinant(&object->placement) == 0)
        object->placement = (struct affine)AFFINE_IDENTITY;
}

struct shape shape_of(struct object_description object,
                      const struct shape_surroundings *surroundings)
{
    struct shape shape;
    struct error error = {.text = ""};
    complete(&object);
    if (shape_create(&object, surroundings ? surroundings : &nothing, &shape, &error) != PS_OK)
        fail_msg("%s", error.text);
    return shape;
}

void expect_no_shape(struct object_description object,
                     const struct shape_surroundings *surroundings, const char *message)
{
    struct shape shape;
    struct error error = {.text = ""};
    complete(&object);
    ps_result result =
        shape_create(&object, surroundings ? surroundings : &nothing, &shape, &error);
    assert_int_equal(result, PS_ERROR_INVALID);
    if (!strstr(error.text, message))
        fail_msg("\"%s\", expected \"%s\"", error.text, message);
    assert_null(shape.vertices);
    assert_null(shape.triangles);
    assert_null(shape.normals);
    assert_null(shape.uv);
}

static ps_vec3 corner(const struct shape *shape, size_t triangle, int k)
{
    return shape->vertices[shape->triangles[triangle][k]];
}

/* Twice the area along the normal. */
static ps_vec3 face(const struct shape *shape, size_t triangle)
{
    ps_vec3 a = corner(shape, triangle, 0);
    return ps_cross(ps_subtract(corner(shape, triangle, 1), a),
                    ps_subtract(corner(shape, triangle, 2), a));
}

double mesh_area(const struct shape *shape)
{
    double sum = 0;
    for (size_t i = 0; i < shape->triangle_count; i++)
        sum += 0.5 * (double)ps_length(face(shape, i));
    return sum;
}

void mesh_area_vector(const struct shape *shape, double sum[3])
{
    sum[0] = sum[1] = sum[2] = 0;
    for (size_t i = 0; i < shape->triangle_count; i++) {
        ps_vec3 twice = face(shape, i);
        sum[0] += 0.5 * (double)twice.x;
        sum[1] += 0.5 * (double)twice.y;
        sum[2] += 0.5 * (double)twice.z;
    }
}

double mesh_volume(const struct shape *shape)
{
    double six = 0;
    for (size_t i = 0; i < shape->triangle_count; i++) {
        ps_vec3 a = ps_subtract(corner(shape, i, 0), shape->vertices[0]);
        six += (double)ps_dot(a, face(shape, i));
    }
    return six / 6;
}

struct place {
    ps_vec3 position;
    uint32_t vertex;
};

static int compare_places(const void *left, const void *right)
{
    const ps_vec3 *a = &((const struct place *)left)->position;
    const ps_vec3 *b = &((const struct place *)right)->position;
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    if (a->y != b->y)
        return a->y < b->y ? -1 : 1;
    return a->z == b->z ? 0 : a->z < b->z ? -1 : 1;
}

/* For each vertex the first of those in its place. */
static uint32_t *weld(const struct shape *shape)
{
    struct place *places = calloc(shape->vertex_count, sizeof *places);
    uint32_t *first = calloc(shape->vertex_count, sizeof *first);
    assert_non_null(places);
    assert_non_null(first);
    for (size_t i = 0; i < shape->vertex_count; i++)
        places[i] = (struct place){shape->vertices[i], (uint32_t)i};
    qsort(places, shape->vertex_count, sizeof *places, compare_places);
    for (size_t i = 0; i < shape->vertex_count; i++) {
        bool same = i > 0 && compare_places(&places[i - 1], &places[i]) == 0;
        first[places[i].vertex] = same ? first[places[i - 1].vertex] : places[i].vertex;
    }
    free(places);
    return first;
}

static int compare_edges(const void *left, const void *right)
{
    const uint64_t *a = left, *b = right;
    return *a == *b ? 0 : *a < *b ? -1 : 1;
}

bool mesh_is_closed(const struct shape *shape)
{
    uint32_t *first = weld(shape);
    size_t count = 3 * shape->triangle_count;
    uint64_t *edges = calloc(count, sizeof *edges);
    assert_non_null(edges);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *triangle = shape->triangles[i / 3];
        uint64_t from = first[triangle[i % 3]], to = first[triangle[(i + 1) % 3]];
        edges[i] = from << 32 | to;
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    bool closed = count > 0;
    for (size_t i = 0; i < count; i++) {
        uint64_t reverse = edges[i] << 32 | edges[i] >> 32;
        closed = closed && (i == 0 || edges[i] != edges[i - 1]) &&
                 bsearch(&reverse, edges, count, sizeof *edges, compare_edges);
    }
    free(edges);
    free(first);
    return closed;
}

void expect_good_normals(const struct shape *shape)
{
    assert_non_null(shape->normals);
    for (size_t i = 0; i < shape->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            ps_vec3 normal = shape->normals[shape->triangles[i][k]];
            expect_near((double)ps_length(normal), 1, 1e-5);
            if (!(ps_dot(normal, face(shape, i)) > 0.0f))
                fail_msg("normal (%g, %g, %g) lies behind triangle %zu", (double)normal.x,
                         (double)normal.y, (double)normal.z, i);
        }
}

void expect_good_uv(const struct shape *shape, int sign)
{
    assert_non_null(shape->uv);
    for (size_t i = 0; i < shape->triangle_count; i++) {
        const float *a = shape->uv[shape->triangles[i][0]], *b = shape->uv[shape->triangles[i][1]];
        const float *c = shape->uv[shape->triangles[i][2]];
        float area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (!((float)sign * area > 0))
            fail_msg("triangle %zu: (%g, %g), (%g, %g), (%g, %g)", i, (double)a[0], (double)a[1],
                     (double)b[0], (double)b[1], (double)c[0], (double)c[1]);
        for (int k = 0; k < 2; k++)
            assert_true(a[k] >= 0 && a[k] <= 1 && b[k] >= 0 && b[k] <= 1 && c[k] >= 0 && c[k] <= 1);
    }
}

void expect_near(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("%.8g, expected %.8g", value, expected);
}

void expect_vector(ps_vec3 p, double x, double y, double z)
{
    double size = fmax(1, fabs(x) + fabs(y) + fabs(z));
    double error = fabs((double)p.x - x) + fabs((double)p.y - y) + fabs((double)p.z - z);
    if (!(error <= 1e-5 * size))
        fail_msg("(%g, %g, %g), expected (%g, %g, %g)", (double)p.x, (double)p.y, (double)p.z, x, y,
                 z);
}
