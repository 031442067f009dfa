/* test_shape.c: shapes given by their corners, what placements do to them, and which have no
 * shape. */
#include "scene/shape.h"

#include "support/memory_limit.h"
#include "support/mesh_facts.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const struct affine mirror = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
static const struct affine sheared_mirror = {{-2, 0.5f, 0}, {1, 3, 0}, {0.5f, 0, 4}, {5, 6, 7}};

/* A lamp of area 2 that shines down, along -z. */
static ps_vec3 lamp_corners[4] = {{0, 0, 0}, {0, 1, 0}, {2, 1, 0}, {2, 0, 0}};
static const struct object_description lamp = {
    .kind = OBJECT_QUAD, .vertices = lamp_corners, .vertex_count = 4};

static ps_vec3 brick_corners[2] = {{1, 4, 3}, {2, 2, 6}}; /* not in order */
static const struct object_description brick = {
    .kind = OBJECT_BOX, .vertices = brick_corners, .vertex_count = 2};

static struct object_description placed(struct object_description object, struct affine placement)
{
    object.placement = placement;
    return object;
}

static void expect_area_vector(const struct shape *shape, double x, double y, double z)
{
    double sum[3];
    mesh_area_vector(shape, sum);
    expect_vector((ps_vec3){(float)sum[0], (float)sum[1], (float)sum[2]}, x, y, z);
}

static void test_quad_has_its_front_and_picture(void **state)
{
    (void)state;
    struct object_description object = lamp;
    object.hidden = true;
    object.material = 5;
    struct shape shape = shape_of(object, NULL);
    static const float uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    expect_area_vector(&shape, 0, 0, -2);
    expect_good_uv(&shape, 1);
    assert_true(shape.hidden);
    assert_int_equal(shape.material, 5);
    assert_null(shape.normals);
    for (int i = 0; i < 4; i++) {
        ps_vec3 corner = lamp_corners[i];
        expect_vector(shape.vertices[i], (double)corner.x, (double)corner.y, (double)corner.z);
        assert_memory_equal(shape.uv[i], uv[i], sizeof uv[i]);
    }
    shape_release(&shape);
}

/* Its mirror image shines down as well, with a mirrored picture; turned over, it shines up. */
static void test_front_stays_the_image_of_the_front(void **state)
{
    (void)state;
    struct shape shape = shape_of(placed(lamp, mirror), NULL);
    expect_area_vector(&shape, 0, 0, -2);
    expect_good_uv(&shape, -1);
    shape_release(&shape);
    struct affine upside_down =
        affine_of((ps_vec3){1, 1, -3}, (ps_vec3){0, 0, 0}, (ps_vec3){0, 0, 9});
    shape = shape_of(placed(lamp, upside_down), NULL);
    expect_area_vector(&shape, 0, 0, 2);
    shape_release(&shape);
}

static void test_box(void **state)
{
    (void)state;
    struct shape shape = shape_of(brick, NULL);
    assert_true(mesh_is_closed(&shape));
    expect_near(mesh_volume(&shape), 6, 1e-6);
    expect_near(mesh_area(&shape), 22, 1e-6);
    expect_good_uv(&shape, 1);
    shape_release(&shape);
    shape = shape_of(placed(brick, sheared_mirror), NULL);
    assert_true(mesh_is_closed(&shape));
    expect_near(mesh_volume(&shape), 6 * -affine_determinant(&sheared_mirror), 1e-5);
    expect_good_uv(&shape, -1);
    shape_release(&shape);
}

/* Where on the box (u, v) lies, on the face whose normal has this component. */
static ps_vec3 on_face(const struct shape *shape, int axis, float side, float u, float v)
{
    for (size_t i = 0; i < shape->vertex_count; i++) {
        const float *p = &shape->vertices[4 * (i / 4)].x, *q = &shape->vertices[4 * (i / 4) + 2].x;
        bool is_face = p[axis] == q[axis] && p[axis] == side;
        if (is_face && shape->uv[i][0] == u && shape->uv[i][1] == v)
            return shape->vertices[i];
    }
    fail_msg("no (%g, %g) on the face at %d %g", (double)u, (double)v, axis, (double)side);
    return (ps_vec3){0, 0, 0};
}

/* Upright on the sides as one walks around; on top as seen from above with -z away. */
static void test_pictures_on_a_box_are_upright(void **state)
{
    (void)state;
    ps_vec3 corners[2] = {{-1, -1, -1}, {1, 1, 1}};
    struct shape shape = shape_of(
        (struct object_description){.kind = OBJECT_BOX, .vertices = corners, .vertex_count = 2},
        NULL);
    expect_vector(on_face(&shape, 2, 1, 0, 0), -1, -1, 1);
    expect_vector(on_face(&shape, 2, 1, 1, 0), 1, -1, 1);
    expect_vector(on_face(&shape, 0, 1, 0, 0), 1, -1, 1);
    expect_vector(on_face(&shape, 0, 1, 1, 1), 1, 1, -1);
    expect_vector(on_face(&shape, 2, -1, 0, 0), 1, -1, -1);
    expect_vector(on_face(&shape, 2, -1, 0, 1), 1, 1, -1);
    expect_vector(on_face(&shape, 0, -1, 0, 0), -1, -1, -1);
    expect_vector(on_face(&shape, 0, -1, 1, 0), -1, -1, 1);
    expect_vector(on_face(&shape, 1, 1, 0, 0), -1, 1, 1);
    expect_vector(on_face(&shape, 1, 1, 0, 1), -1, 1, -1);
    expect_vector(on_face(&shape, 1, -1, 0, 0), -1, -1, -1);
    expect_vector(on_face(&shape, 1, -1, 0, 1), -1, -1, 1);
    shape_release(&shape);
}

/* Corners in one place, on a line and a number that is none; and the two triangles that stay. */
static void test_triangles_without_area_are_dropped(void **state)
{
    (void)state;
    ps_vec3 vertices[] = {{0, 0, 0}, {0.1f, 0.1f, 0.1f}, {0.3f, 0.3f, 0.3f},
                          {1, 0, 0}, {0, 1, 0},          {99, 99, 99}};
    uint32_t triangles[][3] = {{0, 3, 3}, {0, 3, 4}, {0, 1, 2}, {4, 4, 4}, {1, 3, 4}};
    struct shape shape = shape_of((struct object_description){.kind = OBJECT_TRIANGLES,
                                                              .vertices = vertices,
                                                              .vertex_count = 6,
                                                              .triangles = triangles,
                                                              .triangle_count = 5},
                                  NULL);
    assert_int_equal(shape.triangle_count, 2);
    assert_int_equal(shape.dropped, 3);
    assert_memory_equal(shape.triangles[0], triangles[1], sizeof *triangles);
    assert_memory_equal(shape.triangles[1], triangles[4], sizeof *triangles);
    expect_vector(shape.box.low, 0, 0, 0);
    expect_vector(shape.box.high, 1, 1, (double)0.1f);
    shape_release(&shape);
}

static void test_a_list_may_be_empty(void **state)
{
    (void)state;
    const struct mesh_description none = {.vertices = NULL};
    struct shape_surroundings surroundings = {.meshes = &none};
    struct shape shape = shape_of((struct object_description){.kind = OBJECT_TRIANGLES}, NULL);
    assert_int_equal(shape.triangle_count, 0);
    shape_release(&shape);
    shape = shape_of((struct object_description){.kind = OBJECT_MESH}, &surroundings);
    assert_int_equal(shape.triangle_count, 0);
    shape_release(&shape);
}

/* A ridge along z: two slopes, with normals of any length, one of them missing on each slope and
 * one on the ridge. */
static ps_vec3 ridge_vertices[] = {{0, 1, 0}, {0, 1, 1}, {1, 0, 0}, {1, 0, 1}, {-1, 0, 0}};
static ps_vec3 ridge_normals[] = {
    {0, 7, 0}, {0, 0, 0}, {2, 2, 0}, {NAN, 1, 0}, {-1e-30f, 1e-30f, 0}};
static float ridge_uv[][2] = {{0, 1}, {1, 1}, {0, 2}, {1, 2}, {0, 0}};
static uint32_t ridge_triangles[][3] = {{0, 1, 3}, {0, 3, 2}, {0, 4, 1}};

static struct mesh_description ridge(void)
{
    return (struct mesh_description){
        .vertices = ridge_vertices,
        .normals = ridge_normals,
        .uv = ridge_uv,
        .vertex_count = 5,
        .triangles = ridge_triangles,
        .triangle_count = 3,
    };
}

static void test_mesh(void **state)
{
    (void)state;
    const struct mesh_description meshes[2] = {{.vertices = NULL}, ridge()};
    const struct shape_surroundings surroundings = {.meshes = meshes};
    struct shape shape =
        shape_of((struct object_description){.kind = OBJECT_MESH, .mesh = 1}, &surroundings);
    const double diagonal = sqrt(0.5);
    assert_int_equal(shape.vertex_count, 5);
    assert_int_equal(shape.triangle_count, 3);
    assert_memory_equal(shape.uv, ridge_uv, sizeof ridge_uv);
    assert_ptr_not_equal(shape.vertices, ridge_vertices);
    expect_vector(shape.normals[0], 0, 1, 0);
    expect_vector(shape.normals[2], diagonal, diagonal, 0);
    expect_vector(shape.normals[3], diagonal, diagonal, 0); /* of the slope: was no number */
    expect_vector(shape.normals[4], -diagonal, diagonal, 0);
    /* Missing on the ridge: both slopes, by the angles of their triangles there. */
    double right = asin(1), left = atan(sqrt(2)), length = hypot(right - left, right + left);
    expect_vector(shape.normals[1], (right - left) / length, (right + left) / length, 0);
    expect_good_normals(&shape);
    shape_release(&shape);
}

static void test_mesh_placed(void **state)
{
    (void)state;
    struct mesh_description mesh = ridge();
    const struct shape_surroundings surroundings = {.meshes = &mesh};
    struct object_description object = {.kind = OBJECT_MESH};
    struct shape shape = shape_of(placed(object, mirror), &surroundings);
    const double diagonal = sqrt(0.5);
    expect_vector(shape.vertices[2], -1, 0, 0);
    expect_vector(shape.normals[0], 0, 1, 0);
    expect_vector(shape.normals[2], -diagonal, diagonal, 0);
    expect_good_normals(&shape);
    shape_release(&shape);
    shape = shape_of(
        placed(object, affine_of((ps_vec3){3, 1, 1}, (ps_vec3){0, 0, 0}, (ps_vec3){0, 0, 0})),
        &surroundings);
    expect_vector(shape.normals[2], sqrt(0.1), 3 * sqrt(0.1), 0); /* steeper than a point's image */
    shape_release(&shape);
    mesh.normals = NULL;
    mesh.uv = NULL;
    shape = shape_of(placed(object, sheared_mirror), &surroundings);
    assert_null(shape.normals);
    assert_null(shape.uv);
    shape_release(&shape);
}

/* Cofactors of a scale of 1e-25 are no floats. */
static void test_normals_of_tiny_and_thin_placements(void **state)
{
    (void)state;
    struct mesh_description mesh = ridge();
    ps_vec3 normals[] = {{3, 4, 0}, {0, 1, 0}, {1, 1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals = normals;
    const struct shape_surroundings surroundings = {.meshes = &mesh};
    static const ps_vec3 scales[] = {{1e-25f, 1e-25f, 1e-25f}, {1e-7f, 1e-7f, 1e7f}, {1e15f, 1, 1}};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        struct object_description object = {.kind = OBJECT_MESH};
        object.placement = affine_of(scales[i], (ps_vec3){0, 0, 0}, (ps_vec3){0, 0, 0});
        struct shape shape = shape_of(object, &surroundings);
        for (size_t k = 0; k < shape.vertex_count; k++)
            expect_near((double)ps_length(shape.normals[k]), 1, 1e-5);
        if (i == 0)
            expect_vector(shape.normals[0], 0.6, 0.8, 0); /* as stated, not made of faces */
        shape_release(&shape);
    }
}

static void test_no_shape(void **state)
{
    (void)state;
    ps_vec3 point[4] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    ps_vec3 plate[2] = {{0, 0, 0}, {1, 0, 1}};
    struct object_description object = {.kind = OBJECT_QUAD, .vertices = point, .vertex_count = 4};
    expect_no_shape(object, NULL, "quad: it has no area");
    object = (struct object_description){.kind = OBJECT_BOX, .vertices = plate, .vertex_count = 2};
    expect_no_shape(object, NULL, "box: its corners agree");
    expect_no_shape((struct object_description){.kind = OBJECT_INSTANCE}, NULL, "instance");
    expect_no_shape((struct object_description){.kind = (enum object_kind)77}, NULL,
                    "unknown kind");
    expect_no_shape((struct object_description){.kind = OBJECT_MESH}, NULL, "no meshes");
    object = lamp;
    object.placement = (struct affine){{1, 1, 1}, {2, 2, 2}, {0, 0, 1}, {0, 0, 1}};
    object.placement.y.x = 2.0000002f; /* flat but for rounding: allowed */
    struct shape shape = shape_of(object, NULL);
    shape_release(&shape);
    object.placement = (struct affine){{1e30f, 0, 0}, {0, 1e30f, 0}, {0, 0, NAN}, {0, 0, 0}};
    struct error error;
    const struct shape_surroundings nothing = {.radius = 0};
    assert_int_equal(shape_create(&object, &nothing, &shape, &error), PS_ERROR_INVALID);
    object.placement = (struct affine){{1, 1, 1}, {2, 2, 2}, {0, 0, 1}, {0, 0, 1}};
    assert_int_equal(shape_create(&object, &nothing, &shape, &error), PS_ERROR_INVALID);
    object.placement =
        affine_of((ps_vec3){1e30f, 1e30f, 1e30f}, (ps_vec3){0, 0, 0}, (ps_vec3){0, 0, 0});
    lamp_corners[0].x = 1e30f;
    assert_int_equal(shape_create(&object, &nothing, &shape, &error), PS_ERROR_INVALID);
    lamp_corners[0].x = 0;
    assert_null(shape.vertices);
}

/* More than an index can name: refused before a byte of it is read. */
static void test_sizes_are_checked(void **state)
{
    (void)state;
    struct mesh_description mesh = ridge();
    const struct shape_surroundings surroundings = {.meshes = &mesh};
    const struct object_description object = {.kind = OBJECT_MESH, .placement = AFFINE_IDENTITY};
    struct shape shape;
    struct error error;
    mesh.vertex_count = SIZE_MAX / 2;
    assert_int_equal(shape_create(&object, &surroundings, &shape, &error), PS_ERROR_INVALID);
    assert_null(shape.vertices);
    mesh.vertex_count = 5;
    mesh.triangle_count = (size_t)UINT32_MAX + 1;
    assert_int_equal(shape_create(&object, &surroundings, &shape, &error), PS_ERROR_INVALID);
    assert_null(shape.vertices);
}

/* The finest torus wants 0.40 GB for vertices, 0.81 for triangles, 0.40 for normals and 0.27 for
 * (u, v): each limit lets one array more come through than the last. */
static void test_memory_runs_out(void **state)
{
    (void)state;
    if (ADDRESS_SPACE_IS_SHADOWED)
        skip();
    static const double limits[] = {0.2e9, 0.6e9, 1.4e9, 1.7e9};
    const struct shape_surroundings nothing = {.radius = 0};
    const struct object_description object = {.kind = OBJECT_TORUS,
                                              .placement = AFFINE_IDENTITY,
                                              .radius = 2,
                                              .minor_radius = 1,
                                              .segments = SHAPE_SEGMENTS_MAX};
    for (int i = 0; i < 4; i++) {
        struct shape shape;
        struct error error;
        struct rlimit before = limit_memory(limits[i]);
        ps_result result = shape_create(&object, &nothing, &shape, &error);
        assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
        assert_int_equal(result, PS_ERROR_MEMORY);
        assert_null(shape.vertices);
        assert_null(shape.uv);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quad_has_its_front_and_picture),
        cmocka_unit_test(test_front_stays_the_image_of_the_front),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_pictures_on_a_box_are_upright),
        cmocka_unit_test(test_triangles_without_area_are_dropped),
        cmocka_unit_test(test_a_list_may_be_empty),
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_mesh_placed),
        cmocka_unit_test(test_normals_of_tiny_and_thin_placements),
        cmocka_unit_test(test_no_shape),
        cmocka_unit_test(test_sizes_are_checked),
        cmocka_unit_test(test_memory_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
