/* test_shape_sphere.c: exact spheres and ellipsoids: when they are which, and that their pictures
 * and normals agree.
 */
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

static const struct object_description ball = {
    .kind = OBJECT_SPHERE, .center = {1, 2, 3}, .radius = 2};
static struct object_description placed(struct object_description object, struct affine placement)
{
    object.placement = placement;
    return object;
}

/* u = 0 at -x, 1/4 at +z, 1/2 at +x; v from -y to +y. */
static ps_vec3 on_sphere(double u, double v)
{
    double phi = 2 * PI * u, theta = PI * v;
    return (ps_vec3){(float)(-sin(theta) * cos(phi)), (float)-cos(theta),
                     (float)(sin(theta) * sin(phi))};
}

static void test_picture_on_an_exact_sphere(void **state)
{
    (void)state;
    struct shape shape = shape_of(ball, NULL);
    assert_int_equal(shape.kind, SHAPE_SPHERE);
    for (int i = 0; i < 24; i++)
        for (int j = 1; j < 12; j++) {
            float uv[2];
            double u = (i + 0.5) / 24, v = j / 12.0;
            shape_sphere_uv(&shape, on_sphere(u, v), uv);
            assert_true(fabs((double)uv[0] - u) < 1e-5 && fabs((double)uv[1] - v) < 1e-5);
        }
    static const struct {
        ps_vec3 outward;
        float u, v;
    } places[] = {{{0, 0, 1}, 0.25f, 0.5f}, {{1, 0, 0}, 0.5f, 0.5f}, {{0, 0, -1}, 0.75f, 0.5f}};
    for (int i = 0; i < 3; i++) {
        float uv[2];
        shape_sphere_uv(&shape, places[i].outward, uv);
        assert_true(fabsf(uv[0] - places[i].u) < 1e-6f && fabsf(uv[1] - places[i].v) < 1e-6f);
    }
    shape_release(&shape);
}

/* Derivatives against differences of the position. */
static void expect_tangents(const struct shape *shape, double u, double v, const ps_vec3 axes[3])
{
    const double step = 1e-3,
                 positions[4][2] = {{u + step, v}, {u - step, v}, {u, v + step}, {u, v - step}};
    ps_vec3 p[4], along_u, along_v, outward = {0, 0, 0};
    for (int i = 0; i < 5; i++) {
        ps_vec3 own = i < 4 ? on_sphere(positions[i][0], positions[i][1]) : on_sphere(u, v);
        ps_vec3 n =
            ps_add_scaled(ps_add_scaled(ps_scale(axes[0], own.x), own.y, axes[1]), own.z, axes[2]);
        if (i < 4)
            p[i] = ps_scale(n, shape->radius);
        else
            outward = n;
    }
    shape_sphere_tangents(shape, outward, &along_u, &along_v);
    ps_vec3 by_u = ps_scale(ps_subtract(p[0], p[1]), (float)(0.5 / step));
    ps_vec3 by_v = ps_scale(ps_subtract(p[2], p[3]), (float)(0.5 / step));
    float scale = shape->radius * 2 * PS_PI;
    assert_true(ps_length(ps_subtract(by_u, along_u)) < 1e-3f * scale);
    assert_true(ps_length(ps_subtract(by_v, along_v)) < 1e-3f * scale);
}

static void test_tangents_of_a_sphere(void **state)
{
    (void)state;
    const ps_vec3 turn = {10, 20, 30};
    struct affine placements[2] = {affine_of((ps_vec3){3, 3, 3}, turn, (ps_vec3){1, 2, 3}),
                                   affine_of((ps_vec3){-3, 3, 3}, turn, (ps_vec3){1, 2, 3})};
    for (int i = 0; i < 2; i++) {
        struct shape shape = shape_of(placed(ball, placements[i]), NULL);
        const struct affine *map = &placements[i];
        const ps_vec3 axes[3] = {ps_scale(map->x, 1 / 3.0f), ps_scale(map->y, 1 / 3.0f),
                                 ps_scale(map->z, 1 / 3.0f)};
        assert_int_equal(shape.kind, SHAPE_SPHERE);
        for (int k = 0; k < 8; k++)
            for (int j = 1; j < 8; j++)
                expect_tangents(&shape, (k + 0.3) / 8, j / 8.0, axes);
        for (int pole = -1; pole <= 1; pole += 2) {
            ps_vec3 u, v, outward = ps_scale(axes[1], (float)pole);
            float uv[2];
            shape_sphere_tangents(&shape, outward, &u, &v);
            shape_sphere_uv(&shape, outward, uv);
            assert_true(uv[0] >= 0 && uv[0] <= 1);
            assert_true(fabsf(uv[1] - (pole > 0)) < 1e-3f);
            assert_true(ps_length(u) > 0 && ps_length(v) > 0 && isfinite(ps_length(u)));
            expect_near((double)ps_length(v), PI * 6, 1e-3);
            assert_true(fabsf(ps_dot(u, outward)) < 1e-3f * ps_length(u));
            float side = ps_dot(ps_cross(u, v), outward);
            assert_true(i ? side < 0 : side > 0);
        }
        shape_release(&shape);
    }
}

static void test_poles_exactly(void **state)
{
    (void)state;
    struct shape shape = shape_of(ball, NULL);
    for (int i = 0; i < 4; i++) {
        float y = i < 2 ? -1 : 1, zero = i % 2 ? -0.0f : 0.0f;
        float uv[2];
        ps_vec3 u, v;
        shape_sphere_uv(&shape, (ps_vec3){zero, y, zero}, uv);
        shape_sphere_tangents(&shape, (ps_vec3){zero, y, zero}, &u, &v);
        assert_true(uv[0] >= 0 && uv[0] <= 1 && uv[1] == (y > 0 ? 1.0f : 0.0f));
        assert_true(ps_length(u) > 0 && isfinite(ps_length(u)) &&
                    ps_dot(ps_cross(u, v), (ps_vec3){0, y, 0}) > 0);
    }
    shape_release(&shape);
}

/* Exact as long as it is a sphere. */
static void test_when_a_sphere_stays_exact(void **state)
{
    (void)state;
    const ps_vec3 turn = {10, 20, 30}, place = {1, 2, 3};
    struct shape shape = shape_of(placed(ball, affine_of((ps_vec3){-2, 2, 2}, turn, place)), NULL);
    assert_int_equal(shape.kind, SHAPE_SPHERE);
    expect_near((double)shape.radius, 4, 1e-6);
    expect_near((double)ps_dot(shape.axes[0], ps_cross(shape.axes[1], shape.axes[2])), -1, 1e-5);
    shape_release(&shape);
    shape = shape_of(placed(ball, affine_of((ps_vec3){2, 2, 2.001f}, turn, place)), NULL);
    assert_int_equal(shape.kind, SHAPE_MESH);
    shape_release(&shape);
}

/* Prolate: area 2 pi a^2 (1 + c / (a e) asin e), e^2 = 1 - a^2 / c^2. */
static void test_ellipsoid(void **state)
{
    (void)state;
    const ps_vec3 scale = {1, 2, 1};
    struct shape shape =
        shape_of(placed(ball, affine_of(scale, (ps_vec3){10, 20, 30}, (ps_vec3){1, 2, 3})), NULL);
    double a = 2, c = 4, e = sqrt(1 - a * a / (c * c));
    expect_near(mesh_area(&shape), 2 * PI * a * a * (1 + c / (a * e) * asin(e)), 0.001);
    shape_release(&shape);
    const struct affine *const placements[] = {&shear, &sheared_mirror};
    for (int i = 0; i < 2; i++) {
        shape = shape_of(placed(ball, *placements[i]), NULL);
        assert_true(mesh_is_closed(&shape));
        double volume = 4.0 / 3 * PI * 8 * 22.0;
        expect_near(mesh_volume(&shape), i ? 4.0 / 3 * PI * 8 * 26 : volume, 0.002);
        expect_good_normals(&shape);
        expect_good_uv(&shape, i ? -1 : 1);
        assert_int_equal(shape.dropped, 0);
        shape_release(&shape);
    }
}

/* The gradient of |L^-1 (p - c)|^2; and (u, v) are those of the exact sphere that it was. */
static void test_normals_and_picture_of_an_ellipsoid(void **state)
{
    (void)state;
    struct affine back;
    struct shape exact = shape_of(ball, NULL);
    struct shape shape = shape_of(placed(ball, sheared_mirror), NULL);
    assert_true(affine_invert(&sheared_mirror, &back));
    for (size_t i = 0; i < shape.vertex_count; i++) {
        ps_vec3 own = ps_subtract(affine_point(&back, shape.vertices[i]), ball.center);
        ps_vec3 gradient = {ps_dot(own, back.x), ps_dot(own, back.y), ps_dot(own, back.z)};
        gradient = ps_normalize(gradient);
        expect_near((double)ps_length(own), 2, 1e-5);
        assert_true(ps_dot(shape.normals[i], gradient) > 1 - 1e-5f);
        float uv[2];
        shape_sphere_uv(&exact, ps_scale(own, 0.5f), uv);
        bool inner = shape.uv[i][0] > 0.001f && shape.uv[i][0] < 0.999f &&
                     shape.uv[i][1] > 0.001f && shape.uv[i][1] < 0.999f;
        assert_true(fabsf(uv[1] - shape.uv[i][1]) < 1e-4f);
        assert_true(!inner || fabsf(uv[0] - shape.uv[i][0]) < 1e-4f);
    }
    shape_release(&shape);
    shape_release(&exact);
}

/* What shape.h says. */
static void test_error_of_area(void **state)
{
    (void)state;
    struct affine nearly =
        affine_of((ps_vec3){1, 1.0001f, 1}, (ps_vec3){0, 0, 0}, (ps_vec3){0, 0, 0});
    struct shape shape = shape_of(placed(ball, nearly), NULL);
    expect_near(1 - mesh_area(&shape) / (16 * PI * 1.0000667), 0.0005, 0.05);
    shape_release(&shape);
}

static void test_no_sphere(void **state)
{
    (void)state;
    const double bad[] = {0, -1, NAN, INFINITY, 1e300, 1e-300};
    struct object_description object = ball;
    for (int i = 0; i < 6; i++) {
        object.radius = bad[i];
        expect_no_shape(object, NULL, "sphere: radius");
    }
    const ps_vec3 none = {0, 0, 0};
    struct affine huge = affine_of((ps_vec3){1e38f, 1e38f, 1e38f}, none, none);
    expect_no_shape(placed(ball, huge), NULL, "out of range");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_picture_on_an_exact_sphere),
        cmocka_unit_test(test_tangents_of_a_sphere),
        cmocka_unit_test(test_poles_exactly),
        cmocka_unit_test(test_when_a_sphere_stays_exact),
        cmocka_unit_test(test_ellipsoid),
        cmocka_unit_test(test_normals_and_picture_of_an_ellipsoid),
        cmocka_unit_test(test_error_of_area),
        cmocka_unit_test(test_no_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
