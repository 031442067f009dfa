/* test_scene.c: shapes and their transforms, bounds, and the camera. */
#include "scene/scene.h"

#include "scene/shape.h"
#include "support/mesh_facts.h"
#include "support/render_scene.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

static struct shape lone_shape(struct object_description object)
{
    return shape_of(object, NULL);
}

/* Where a transform carries a point: the first corner of a quad. */
static ps_vec3 transformed(ps_vec3 scale, ps_vec3 rotate, ps_vec3 translate, ps_vec3 p)
{
    ps_vec3 corners[4] = {p, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    struct shape shape = lone_shape((struct object_description){
        .kind = OBJECT_QUAD,
        .placement = affine_of(scale, rotate, translate),
        .vertices = corners,
        .vertex_count = 4,
    });
    ps_vec3 result = shape.vertices[0];
    shape_release(&shape);
    return result;
}

static ps_vec3 rotated(ps_vec3 degrees, ps_vec3 p)
{
    return transformed((ps_vec3){1, 1, 1}, degrees, (ps_vec3){0, 0, 0}, p);
}

/* Right-handed: a quarter turn about x takes y to z, about y takes z to x, about z takes x to y. */
static void test_rotations_are_right_handed(void **state)
{
    (void)state;
    expect_vector(rotated((ps_vec3){90, 0, 0}, (ps_vec3){1, 2, 3}), 1, -3, 2);
    expect_vector(rotated((ps_vec3){0, 90, 0}, (ps_vec3){1, 2, 3}), 3, 2, -1);
    expect_vector(rotated((ps_vec3){0, 0, 90}, (ps_vec3){1, 2, 3}), -2, 1, 3);
    expect_vector(rotated((ps_vec3){0, 0, 30}, (ps_vec3){1, 0, 0}), sqrt(0.75), 0.5, 0);
    expect_vector(rotated((ps_vec3){0, -45, 0}, (ps_vec3){0, 0, 1}), -sqrt(0.5), 0, sqrt(0.5));
}

static void test_rotations_go_x_y_z(void **state)
{
    (void)state;
    expect_vector(rotated((ps_vec3){90, 90, 0}, (ps_vec3){0, 1, 0}), 1, 0, 0);
    expect_vector(rotated((ps_vec3){0, 90, 90}, (ps_vec3){0, 0, 1}), 0, 1, 0);
    expect_vector(rotated((ps_vec3){90, 0, 90}, (ps_vec3){0, 0, 1}), 1, 0, 0);
    expect_vector(rotated((ps_vec3){90, 90, 90}, (ps_vec3){1, 2, 3}), 3, 2, -1);
}

static void test_scale_rotate_translate(void **state)
{
    (void)state;
    const ps_vec3 scale = {2, 3, 4}, rotate = {0, 0, 90}, translate = {10, 20, 30};
    expect_vector(transformed(scale, rotate, translate, (ps_vec3){1, 1, 1}), 7, 22, 34);
    expect_vector(transformed((ps_vec3){-1, 1, 1}, rotate, translate, (ps_vec3){1, 0, 0}), 10, 19,
                  30);
}

static void test_quad(void **state)
{
    (void)state;
    ps_vec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    struct shape shape = lone_shape((struct object_description){
        .kind = OBJECT_QUAD, .material = 3, .vertices = corners, .vertex_count = 4});
    double area = 0;
    assert_int_equal(shape.kind, SHAPE_MESH);
    assert_int_equal(shape.material, 3);
    assert_int_equal(shape.triangle_count, 2);
    for (size_t i = 0; i < 2; i++) {
        const uint32_t *t = shape.triangles[i];
        ps_vec3 a = ps_subtract(shape.vertices[t[1]], shape.vertices[t[0]]);
        ps_vec3 b = ps_subtract(shape.vertices[t[2]], shape.vertices[t[0]]);
        area += 0.5 * ps_cross(a, b).z;
    }
    expect_vector((ps_vec3){(float)area, 0, 0}, 1, 0, 0); /* covers it once, one way around */
    shape_release(&shape);
}

static double triple(ps_vec3 a, ps_vec3 b, ps_vec3 c)
{
    return ps_dot(ps_cross(a, b), c);
}

/* A closed, outward mesh has its volume by the divergence theorem, and no surplus of area. */
static void expect_box(const struct shape *shape, double volume, double area)
{
    double six_volumes = 0, two_areas = 0;
    assert_int_equal(shape->vertex_count, 24);
    assert_int_equal(shape->triangle_count, 12);
    for (size_t i = 0; i < 12; i++) {
        ps_vec3 a = shape->vertices[shape->triangles[i][0]];
        ps_vec3 b = shape->vertices[shape->triangles[i][1]];
        ps_vec3 c = shape->vertices[shape->triangles[i][2]];
        six_volumes += triple(a, b, c);
        two_areas += ps_length(ps_cross(ps_subtract(b, a), ps_subtract(c, a)));
    }
    assert_true(fabs(six_volumes / 6 - volume) < 1e-4 * fabs(volume));
    assert_true(fabs(two_areas / 2 - area) < 1e-4 * area);
}

static void test_box(void **state)
{
    (void)state;
    ps_vec3 corners[2] = {{1, 2, 3}, {2, 4, 6}};
    struct object_description object = {.kind = OBJECT_BOX, .vertices = corners, .vertex_count = 2};
    struct shape shape = lone_shape(object);
    expect_box(&shape, 1 * 2 * 3, 2 * (2 + 3 + 6));
    expect_vector(shape.box.low, 1, 2, 3);
    expect_vector(shape.box.high, 2, 4, 6);
    shape_release(&shape);
    object.placement = affine_of((ps_vec3){2, 2, 2}, (ps_vec3){10, 20, 30}, (ps_vec3){7, 8, 9});
    shape = lone_shape(object);
    expect_box(&shape, 8 * 6, 4 * 22);
    shape_release(&shape);
}

static void test_box_turns_as_a_whole(void **state)
{
    (void)state;
    ps_vec3 corners[2] = {{0, 0, 0}, {1, 2, 3}};
    struct shape shape = lone_shape((struct object_description){
        .kind = OBJECT_BOX,
        .vertices = corners,
        .vertex_count = 2,
        .placement = affine_of((ps_vec3){1, 1, 1}, (ps_vec3){0, 90, 0}, (ps_vec3){5, 0, 0}),
    });
    expect_vector(shape.box.low, 5, 0, -1);
    expect_vector(shape.box.high, 8, 2, 0);
    shape_release(&shape);
}

static void test_sphere(void **state)
{
    (void)state;
    struct shape shape = lone_shape((struct object_description){
        .kind = OBJECT_SPHERE,
        .center = {1, 0, 0},
        .radius = 2,
        .placement = affine_of((ps_vec3){-3, -3, -3}, (ps_vec3){0, 0, 90}, (ps_vec3){0, 0, 1}),
    });
    assert_int_equal(shape.kind, SHAPE_SPHERE);
    expect_vector(shape.center, 0, -3, 1);
    assert_true(fabsf(shape.radius - 6) < 1e-5f);
    expect_vector(shape.box.low, -6, -9, -5);
    expect_vector(shape.box.high, 6, 3, 7);
    shape_release(&shape);
}

/* From the text, through the parser, to world space. */
static void test_scene_bounds(void **state)
{
    (void)state;
    struct scene scene = scene_of_text(
        "psd: 1\n"
        "camera: {location: [0, 0, 9], look_at: [0, 0, 0], angle: 60}\n"
        "image: {width: 32, height: 16}\n"
        "materials: {grey: {diffuse: 0.5}, red: {diffuse: [1, 0, 0]}}\n"
        "objects:\n"
        "  - box: {corners: [[0, 0, 0], [1, 1, 1]], scale: [2, 4, 4], rotate: [0, 90, 0],\n"
        "          translate: [1, 0, 0], material: red}\n"
        "  - sphere: {center: [4, 2, -1], radius: 1, material: grey}\n");
    assert_int_equal(scene.shape_count, 2);
    assert_int_equal(scene.width, 32);
    assert_int_equal(scene.height, 16);
    /* The box fills (1, 0, -2) to (5, 4, 0), and the sphere lies within it. */
    expect_vector(scene.center, 3, 2, -1);
    assert_true(fabsf(scene.radius - 3) < 1e-5f);
    assert_true(scene.surface_offset > 0 && scene.surface_offset < 1e-3f * scene.radius);
    assert_true(scene.materials[scene.shapes[0].material].components[0].diffuse.colors[0].r == 1);
    assert_true(scene.materials[scene.shapes[1].material].components[0].diffuse.colors[0].r ==
                0.5f);
    scene_release(&scene);
}

static struct camera camera(double angle, double vertical_angle, size_t width, size_t height)
{
    const struct camera_description description = {
        .location = {1, 2, 3},
        .look_at = {1, 2, -7},
        .up = {0, 2, 0},
        .angle = angle,
        .vertical_angle = vertical_angle,
    };
    return camera_from_description(&description, width, height);
}

static void expect_ray(const struct camera *camera, double x, double y, double across, double up)
{
    ps_ray ray = camera_ray(camera, (float)x, (float)y, NULL);
    double length = sqrt(across * across + up * up + 1);
    expect_vector(ray.origin, 1, 2, 3);
    expect_vector(ray.direction, across / length, up / length, -1 / length);
    assert_true(ray.tnear == 0 && isinf(ray.tfar));
}

/* Looking along -z with y up, x grows to the right: right-handed. */
static void expect_picture(const struct camera *camera, double width, double height,
                           double half_width, double half_height)
{
    expect_ray(camera, width / 2, height / 2, 0, 0);
    expect_ray(camera, 0, 0, -half_width, half_height);
    expect_ray(camera, width, 0, half_width, half_height);
    expect_ray(camera, 0, height, -half_width, -half_height);
    expect_ray(camera, width, height, half_width, -half_height);
    expect_ray(camera, width, height / 2, half_width, 0);
    expect_ray(camera, width / 4, height / 2, -half_width / 2, 0);
}

static void test_camera_angles(void **state)
{
    (void)state;
    double half = tan(35 * PI / 180);
    struct camera horizontal = camera(70, 0, 160, 90), vertical = camera(0, 70, 160, 90);
    struct camera tall = camera(70, 0, 30, 60);
    expect_picture(&horizontal, 160, 90, half, half * 9 / 16);
    expect_picture(&vertical, 160, 90, half * 16 / 9, half);
    expect_picture(&tall, 30, 60, half, half * 2);
}

static void test_camera_aims_and_stays_upright(void **state)
{
    (void)state;
    const struct camera_description description = {
        .location = {5, 1, 2}, .look_at = {1, 4, -3}, .up = {0, 1, 0}, .angle = 40};
    struct camera view = camera_from_description(&description, 64, 48);
    ps_vec3 forward = ps_normalize((ps_vec3){-4, 3, -5});
    expect_vector(camera_ray(&view, 32, 24, NULL).direction, forward.x, forward.y, forward.z);
    assert_true(fabsf(view.across.y) < 1e-7f); /* the horizon is level */
    assert_true(view.down.y < 0);
    assert_true(fabsf(ps_dot(view.across, view.down)) < 1e-9f);
    assert_true(fabsf(ps_length(view.across) / ps_length(view.down) - 1) < 1e-5f);
}

/* Points at any depth along rays come back to where the rays went through the picture. */
static void expect_projection(const struct camera *camera)
{
    static const float pinhole[2] = {0, 0};
    for (int i = 0; i < 49; i++) {
        float x = (float)(i % 7) * 12.0f - 4.0f, y = (float)(i / 7) * 9.0f - 3.0f, found_x, found_y;
        ps_ray ray = camera_ray(camera, x, y, pinhole);
        ps_vec3 point = ps_add_scaled(ray.origin, 0.5f + (float)i, ray.direction);
        ps_vec3 behind = ps_add_scaled(ray.origin, -1.0f, ray.direction);
        assert_true(camera_project(camera, point, &found_x, &found_y));
        assert_true(fabsf(found_x - x) < 1e-2f && fabsf(found_y - y) < 1e-2f);
        assert_false(camera_project(camera, behind, &found_x, &found_y));
    }
}

static void test_camera_projects_where_its_rays_went(void **state)
{
    (void)state;
    struct camera_description description = {
        .location = {5, 1, 2}, .look_at = {1, 4, -3}, .up = {0, 1, 0}, .angle = 40};
    struct camera perspective = camera_from_description(&description, 64, 48);
    expect_projection(&perspective);
    description.aperture = 0.3; /* the middle of the lens counts */
    struct camera lens = camera_from_description(&description, 64, 48);
    expect_projection(&lens);
    description.aperture = 0;
    description.kind = CAMERA_ORTHOGRAPHIC;
    description.width = 3;
    struct camera parallel = camera_from_description(&description, 64, 48);
    expect_projection(&parallel);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rotations_are_right_handed),
        cmocka_unit_test(test_rotations_go_x_y_z),
        cmocka_unit_test(test_scale_rotate_translate),
        cmocka_unit_test(test_quad),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_box_turns_as_a_whole),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_scene_bounds),
        cmocka_unit_test(test_camera_angles),
        cmocka_unit_test(test_camera_projects_where_its_rays_went),
        cmocka_unit_test(test_camera_aims_and_stays_upright),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
