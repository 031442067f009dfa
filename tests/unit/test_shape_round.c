/* test_shape_round.c: cylinders, cones, discs and tori against closed forms, and their ends,
 * normals and pictures. */
#include "scene/shape.h"

#include "support/mesh_facts.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

static const struct affine shear = {{2, 0.5f, 0}, {1, 3, 0}, {0.5f, 0, 4}, {5, 6, 7}};
static const struct affine sheared_mirror = {{-2, 0.5f, 0}, {1, 3, 0}, {0.5f, 0, 4}, {5, 6, 7}};

static const struct object_description cylinder = {
    .kind = OBJECT_CYLINDER, .points = {{1, 2, 3}, {2, 4, 5}}, .radius = 0.5};
static const struct object_description cone = {
    .kind = OBJECT_CONE, .points = {{1, 2, 3}, {2, 4, 5}}, .radius = 2, .to_radius = 0.5};
static const struct object_description disc = {
    .kind = OBJECT_DISC, .center = {1, 2, 3}, .normal = {0, 7, 0}, .radius = 2};
static const struct object_description torus = {
    .kind = OBJECT_TORUS, .radius = 2, .minor_radius = 0.5};

static struct object_description placed(struct object_description object, struct affine placement)
{
    object.placement = placement;
    return object;
}

/* The area of a polygon of n corners, in that of its circle; and its height in the radius. */
static double polygon(double n)
{
    return sin(2 * PI / n) / (2 * PI / n);
}

/* A closed shape, of this volume and area, with good normals and pictures; and its images under
 * placements that shear, and mirror. */
static void expect_solid(struct object_description object, double volume, double area,
                         double relative)
{
    struct shape shape = shape_of(object, NULL);
    assert_true(mesh_is_closed(&shape));
    expect_near(mesh_volume(&shape), volume, relative);
    expect_near(mesh_area(&shape), area, relative);
    assert_true(mesh_volume(&shape) < volume * (1 + 1e-6)); /* convex, or nearly: from within */
    expect_good_normals(&shape);
    expect_good_uv(&shape, 1);
    assert_int_equal(shape.dropped, 0);
    shape_release(&shape);
    const struct affine *const placements[] = {&shear, &sheared_mirror};
    for (int i = 0; i < 2; i++) {
        shape = shape_of(placed(object, *placements[i]), NULL);
        assert_true(mesh_is_closed(&shape));
        expect_near(mesh_volume(&shape), volume * fabs(affine_determinant(placements[i])),
                    relative);
        expect_good_normals(&shape);
        expect_good_uv(&shape, i ? -1 : 1);
        shape_release(&shape);
    }
}

static void test_solids_have_their_volume_and_area(void **state)
{
    (void)state;
    struct object_description object = cylinder;
    expect_solid(object, PI * 0.25 * 3, 2 * PI * 0.5 * 3 + 2 * PI * 0.25, 0.002);
    object = cone;
    double slant = hypot(3, 1.5);
    expect_solid(object, PI * 3 / 3 * (4 + 1 + 0.25), PI * 2.5 * slant + PI * 4.25, 0.002);
    object.to_radius = 0;
    expect_solid(object, PI * 4, PI * 2 * hypot(3, 2) + PI * 4, 0.002);
    object.to_radius = 2;
    object.radius = 0;
    expect_solid(object, PI * 4, PI * 2 * hypot(3, 2) + PI * 4, 0.002);
    object = torus;
    expect_solid(object, 2 * PI * PI * 2 * 0.25, 4 * PI * PI * 2 * 0.5, 0.01);
    object.segments = 8;
    expect_solid(object, 2 * PI * PI * 2 * 0.25, 4 * PI * PI * 2 * 0.5, 0.5);
}

/* What shape.h says about 64 segments, and that the error falls with their square. */
static void test_error_of_area(void **state)
{
    (void)state;
    struct object_description object = cylinder;
    object.open = true;
    struct shape shape = shape_of(object, NULL);
    expect_near(1 - mesh_area(&shape) / (3 * PI), 0.0004, 0.05);
    shape_release(&shape);
    shape = shape_of(torus, NULL);
    expect_near(1 - mesh_area(&shape) / (4 * PI * PI), 0.0026, 0.05);
    shape_release(&shape);
    const int64_t segments[] = {3, 64, 128, 1024};
    for (int i = 0; i < 4; i++) {
        object = disc;
        object.segments = segments[i];
        shape = shape_of(object, NULL);
        expect_near(mesh_area(&shape), 4 * PI * polygon((double)segments[i]), 1e-5);
        shape_release(&shape);
    }
    expect_near(1 - polygon(64), 0.0016, 0.01);
}

/* Without ends: no caps, so the sum of the normals is that of the ends, and there is no edge that
 * could close it. */
static void test_open_ends(void **state)
{
    (void)state;
    const struct object_description *const objects[] = {&cylinder, &cone};
    for (int i = 0; i < 2; i++) {
        struct object_description object = *objects[i];
        object.open = true;
        struct shape closed = shape_of(*objects[i], NULL), open = shape_of(object, NULL);
        double ends =
            PI * (object.radius * object.radius +
                  (i ? object.to_radius : object.radius) * (i ? object.to_radius : object.radius));
        assert_false(mesh_is_closed(&open));
        expect_near(mesh_area(&closed) - mesh_area(&open), ends, 0.002);
        expect_good_normals(&open);
        shape_release(&closed);
        shape_release(&open);
    }
}

/* The fewest segments: a prism of three sides, and a tube of three around a triangle. */
static void test_three_segments(void **state)
{
    (void)state;
    const struct object_description *const objects[] = {&cylinder, &cone, &torus};
    for (int i = 0; i < 3; i++) {
        struct object_description object = *objects[i];
        object.segments = 3;
        struct shape shape = shape_of(object, NULL);
        assert_true(mesh_is_closed(&shape));
        assert_true(mesh_volume(&shape) > 0);
        expect_good_normals(&shape);
        if (i == 0)
            expect_near(mesh_volume(&shape), 3 * PI * 0.25 * polygon(3), 1e-5);
        shape_release(&shape);
    }
}

/* A ring of ends and sides has two normals: the edge is sharp. */
static void test_normals_of_a_cylinder(void **state)
{
    (void)state;
    struct shape shape = shape_of((struct object_description){.kind = OBJECT_CYLINDER,
                                                              .points = {{0, 0, 0}, {0, 3, 0}},
                                                              .radius = 2},
                                  NULL);
    int sides = 0, ends = 0;
    for (size_t i = 0; i < shape.vertex_count; i++) {
        ps_vec3 p = shape.vertices[i], n = shape.normals[i];
        if (fabsf(n.y) > 0.5f) {
            expect_vector(n, 0, p.y > 1 ? 1 : -1, 0);
            ends++;
        } else {
            expect_vector(n, (double)p.x / 2, 0, (double)p.z / 2);
            sides++;
        }
    }
    assert_int_equal(sides, 2 * 65);
    assert_int_equal(ends, 2 * 65);
    shape_release(&shape);
}

/* (p.x, p.y) on the profile: along the slope the normal is across it. */
static void test_normals_of_a_cone(void **state)
{
    (void)state;
    struct object_description object = {
        .kind = OBJECT_CONE, .points = {{0, 0, 0}, {0, 4, 0}}, .radius = 3, .open = true};
    struct shape shape = shape_of(object, NULL);
    assert_int_equal(shape.triangle_count, 64); /* no slivers at the tip */
    for (size_t i = 0; i < shape.vertex_count; i++) {
        ps_vec3 n = shape.normals[i];
        expect_near((double)n.y, 0.6, 1e-5);
        expect_near(hypot((double)n.x, (double)n.z), 0.8, 1e-5);
    }
    for (size_t i = 0; i < 64; i++) { /* each tip in the middle of its segment */
        const uint32_t *t = shape.triangles[i];
        expect_near((double)shape.uv[t[2]][0], ((double)i + 0.5) / 64, 1e-5);
        ps_vec3 middle = ps_add(shape.vertices[t[0]], shape.vertices[t[1]]);
        ps_vec3 tip = shape.normals[t[2]];
        assert_true(fabsf(middle.x * tip.z - middle.z * tip.x) < 1e-4f);
    }
    shape_release(&shape);
}

/* Where the mesh has (u, v), on the vertices that face away from the axis or not. */
static ps_vec3 at_uv(const struct shape *shape, float u, float v)
{
    for (size_t i = 0; i < shape->vertex_count; i++)
        if (fabsf(shape->uv[i][0] - u) < 1e-6f && fabsf(shape->uv[i][1] - v) < 1e-6f)
            return shape->vertices[i];
    fail_msg("no vertex at (%g, %g)", (double)u, (double)v);
    return (ps_vec3){0, 0, 0};
}

static void test_pictures_go_around(void **state)
{
    (void)state;
    struct object_description object = {
        .kind = OBJECT_CYLINDER, .points = {{0, 0, 0}, {0, 3, 0}}, .radius = 2, .open = true};
    struct shape shape = shape_of(object, NULL);
    expect_vector(at_uv(&shape, 0, 0), -2, 0, 0);
    expect_vector(at_uv(&shape, 0.25f, 0), 0, 0, 2);
    expect_vector(at_uv(&shape, 0.5f, 1), 2, 3, 0);
    expect_vector(at_uv(&shape, 1, 1), -2, 3, 0);
    shape_release(&shape);
    shape = shape_of(torus, NULL);
    expect_vector(at_uv(&shape, 0, 0), -1.5, 0, 0);
    expect_vector(at_uv(&shape, 0.25f, 0.5f), 0, 0, 2.5);
    expect_vector(at_uv(&shape, 0.5f, 0.75f), 2, 0.5, 0);
    expect_vector(at_uv(&shape, 0.75f, 0.25f), 0, -0.5, -2);
    shape_release(&shape);
    shape = shape_of(disc, NULL);
    expect_vector(at_uv(&shape, 0.5f, 0.5f), 1, 2, 3);
    expect_vector(at_uv(&shape, 1, 0.5f), 3, 2, 3);
    expect_vector(at_uv(&shape, 0.5f, 1), 1, 2, 1);
    shape_release(&shape);
}

static void test_disc(void **state)
{
    (void)state;
    struct object_description object = disc;
    for (int i = 0; i < 2; i++) {
        object.hole_radius = i ? 1.5 : 0;
        struct shape shape = shape_of(object, NULL);
        double sum[3], area = PI * (4 - object.hole_radius * object.hole_radius);
        mesh_area_vector(&shape, sum);
        expect_near(sum[1], area, 0.002);
        assert_true(fabs(sum[0]) < 1e-5 && fabs(sum[2]) < 1e-5);
        expect_near(mesh_area(&shape), sum[1], 1e-5);
        expect_good_normals(&shape);
        expect_good_uv(&shape, 1);
        for (size_t k = 0; k < shape.vertex_count; k++) {
            ps_vec3 p = ps_subtract(shape.vertices[k], disc.center);
            assert_true((double)ps_length(p) > object.hole_radius - 1e-5);
            expect_vector(shape.normals[k], 0, 1, 0);
        }
        shape_release(&shape);
        shape = shape_of(placed(object, sheared_mirror), NULL);
        mesh_area_vector(&shape, sum);
        expect_vector(ps_normalize((ps_vec3){(float)sum[0], (float)sum[1], (float)sum[2]}),
                      (double)shape.normals[0].x, (double)shape.normals[0].y,
                      (double)shape.normals[0].z);
        assert_true(sum[1] > 0); /* y still points up: so does the front */
        shape_release(&shape);
    }
}

/* Along and against each axis the frame of the ends must hold. */
static void test_axes_every_way(void **state)
{
    (void)state;
    for (int axis = 0; axis < 6; axis++) {
        float way[3] = {-0.0f, -0.0f, -0.0f};
        way[axis / 2] = axis % 2 ? 3.0f : -3.0f;
        struct object_description object = cylinder;
        object.points[0] = (ps_vec3){0, 0, 0};
        object.points[1] = (ps_vec3){way[0], way[1], way[2]};
        expect_solid(object, PI * 0.25 * 3, 2 * PI * 0.5 * 3 + 2 * PI * 0.25, 0.002);
    }
}

static void test_minus_zero_is_zero(void **state)
{
    (void)state;
    struct object_description object = disc;
    object.normal = (ps_vec3){1, 0, 0};
    struct shape shape = shape_of(object, NULL);
    object.normal = (ps_vec3){1, -0.0f, -0.0f};
    struct shape again = shape_of(object, NULL);
    for (size_t i = 0; i < shape.vertex_count; i++) {
        ps_vec3 p = shape.vertices[i];
        expect_vector(again.vertices[i], (double)p.x, (double)p.y, (double)p.z);
    }
    shape_release(&shape);
    shape_release(&again);
}

static void test_no_round_shape(void **state)
{
    (void)state;
    struct object_description object;
    const double bad[] = {0, -1, NAN, INFINITY, 1e300, 1e-300};
    for (int i = 0; i < 6; i++) {
        object = cylinder;
        object.radius = bad[i];
        expect_no_shape(object, NULL, "cylinder: radius");
        object = disc;
        object.radius = bad[i];
        expect_no_shape(object, NULL, "disc: radius");
        object = torus;
        object.minor_radius = bad[i];
        expect_no_shape(object, NULL, "torus: radius");
        object = cone;
        object.radius = bad[i];
        object.to_radius = 0;
        expect_no_shape(object, NULL, "radius");
    }
    object = cylinder;
    object.points[1] = object.points[0];
    expect_no_shape(object, NULL, "no axis");
    object.points[0].x = -3e38f;
    object.points[1].x = 3e38f;
    expect_no_shape(object, NULL, "no axis");
    object = disc;
    object.normal = (ps_vec3){0, -0.0f, 0};
    expect_no_shape(object, NULL, "normal");
    object = disc;
    object.hole_radius = 2;
    expect_no_shape(object, NULL, "hole_radius");
    object.hole_radius = -1;
    expect_no_shape(object, NULL, "hole_radius");
    object = torus;
    object.minor_radius = 2;
    expect_no_shape(object, NULL, "below radius");
    const int64_t segments[] = {-1, 1, 2, 8193, INT64_MAX};
    for (int i = 0; i < 5; i++) {
        object = torus;
        object.segments = segments[i];
        expect_no_shape(object, NULL, "segments");
        object = disc;
        object.segments = segments[i];
        expect_no_shape(object, NULL, "segments");
        object = cone;
        object.segments = segments[i];
        expect_no_shape(object, NULL, "segments");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_solids_have_their_volume_and_area),
        cmocka_unit_test(test_error_of_area),
        cmocka_unit_test(test_open_ends),
        cmocka_unit_test(test_three_segments),
        cmocka_unit_test(test_normals_of_a_cylinder),
        cmocka_unit_test(test_normals_of_a_cone),
        cmocka_unit_test(test_pictures_go_around),
        cmocka_unit_test(test_disc),
        cmocka_unit_test(test_axes_every_way),
        cmocka_unit_test(test_minus_zero_is_zero),
        cmocka_unit_test(test_no_round_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
