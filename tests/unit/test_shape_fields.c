/* test_shape_fields.c: planes and height fields: shapes that take from what is around them. */
#include "scene/shape.h"

#include "support/mesh_facts.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

static const struct shape_surroundings surroundings = {.center = {10, 20, 30}, .radius = 5};
static const struct affine sheared_mirror = {{-2, 0.5f, 0}, {1, 3, 0}, {0.5f, 0, 4}, {5, 6, 7}};

/* Where the square has these lengths as (u, v). */
static ps_vec3 corner(const struct shape *shape, int i)
{
    return shape->vertices[i];
}

static void test_plane_of_stated_extent(void **state)
{
    (void)state;
    struct shape shape = shape_of(
        (struct object_description){
            .kind = OBJECT_PLANE, .normal = {0, 2, 0}, .distance = 6, .extent = 4},
        &surroundings);
    double sum[3];
    mesh_area_vector(&shape, sum);
    expect_near(sum[1], 64, 1e-6);
    for (int i = 0; i < 4; i++) {
        ps_vec3 p = corner(&shape, i); /* normal . p = distance, pictures along x and -z */
        expect_vector(p, (double)shape.uv[i][0], 3, -(double)shape.uv[i][1]);
        assert_true(fabsf(p.x) == 4 && fabsf(p.z) == 4);
    }
    shape_release(&shape);
}

/* The plane's image holds the corners of a true square around the point nearest to the
 * surroundings, of 4 radii; (u, v) are lengths in the object's own units. */
static void expect_automatic(struct object_description object,
                             const struct shape_surroundings *around, double extent)
{
    struct shape shape = shape_of(object, around);
    double length = (double)ps_length(object.normal);
    ps_vec3 unit = ps_scale(object.normal, (float)(1 / length)), u, v;
    ps_frame(unit, &u, &v);
    ps_vec3 origin = ps_scale(unit, (float)(object.distance / length));
    ps_vec3 middle = ps_scale(ps_add(corner(&shape, 0), corner(&shape, 2)), 0.5f);
    for (int i = 0; i < 4; i++) {
        ps_vec3 p = ps_add_scaled(ps_add_scaled(origin, shape.uv[i][0], u), shape.uv[i][1], v);
        ps_vec3 q = affine_point(&object.placement, p), r = corner(&shape, i);
        assert_true(ps_length(ps_subtract(q, r)) < 1e-3f);
        expect_near((double)ps_length(ps_subtract(r, corner(&shape, (i + 1) % 4))), 2 * extent,
                    1e-4);
        expect_near((double)ps_length(ps_subtract(r, middle)), sqrt(2) * extent, 1e-4);
    }
    double sum[3];
    mesh_area_vector(&shape, sum);
    ps_vec3 front = {(float)sum[0], (float)sum[1], (float)sum[2]};
    ps_vec3 image = affine_direction(&object.placement, unit);
    assert_true(ps_dot(front, image) > 0);
    if (around->radius > 0) {
        ps_vec3 away = ps_subtract(around->center, middle);
        ps_vec3 across = ps_cross(away, ps_normalize(front));
        assert_true(ps_length(across) < 1e-2f);
    } else {
        ps_vec3 place = affine_point(&object.placement, origin);
        expect_vector(middle, (double)place.x, (double)place.y, (double)place.z);
    }
    shape_release(&shape);
}

static void test_plane_reaches_around_the_rest(void **state)
{
    (void)state;
    struct object_description object = {.kind = OBJECT_PLANE, .normal = {1, 2, -2}, .distance = 6};
    const struct shape_surroundings nothing = {.center = {7, 7, 7}, .radius = 0};
    object.placement = (struct affine)AFFINE_IDENTITY;
    expect_automatic(object, &surroundings, 20);
    expect_automatic(object, &nothing, 1);
    object.placement = affine_of((ps_vec3){3, 3, 3}, (ps_vec3){10, 20, 30}, (ps_vec3){1, 2, 3});
    expect_automatic(object, &surroundings, 20);
    object.placement = sheared_mirror;
    expect_automatic(object, &surroundings, 20);
    expect_automatic(object, &nothing, 1);
}

/* Just below the box in the space where the plane will be, whatever placed it. */
static void test_plane_below_all(void **state)
{
    (void)state;
    const struct box box = {{-1, -2, -3}, {4, 5, 6}};
    const struct shape_surroundings around = {.center = {1, 1, 1}, .radius = 7, .box = &box};
    const struct shape_surroundings nothing = {.radius = 0};
    const struct affine placements[] = {
        AFFINE_IDENTITY, affine_of((ps_vec3){2, 3, 4}, (ps_vec3){10, 20, 30}, (ps_vec3){5, -6, 7}),
        affine_of((ps_vec3){1, -1, 1}, (ps_vec3){0, 0, 0}, (ps_vec3){0, 9, 0})};
    struct object_description object = {
        .kind = OBJECT_PLANE, .normal = {0, 4, 0}, .distance = DISTANCE_BELOW_ALL, .extent = 3};
    for (size_t i = 0; i < sizeof placements / sizeof placements[0]; i++) {
        object.placement = placements[i];
        struct shape shape = shape_of(object, &around);
        double sum[3], nearest = INFINITY;
        mesh_area_vector(&shape, sum);
        ps_vec3 front = ps_normalize((ps_vec3){(float)sum[0], (float)sum[1], (float)sum[2]});
        for (unsigned k = 0; k < 8; k++)
            nearest =
                fmin(nearest,
                     (double)ps_dot(front, ps_subtract(box_corner(&box, k), corner(&shape, 0))));
        expect_near(nearest, 1e-3 * sqrt(25 + 49 + 81), 1e-4);
        shape_release(&shape);
        shape = shape_of(object, &nothing);
        ps_vec3 middle = ps_scale(ps_add(corner(&shape, 0), corner(&shape, 2)), 0.5f);
        expect_vector(middle, (double)object.placement.translation.x,
                      (double)object.placement.translation.y,
                      (double)object.placement.translation.z);
        shape_release(&shape);
    }
}

static void test_no_plane(void **state)
{
    (void)state;
    struct object_description object = {.kind = OBJECT_PLANE, .distance = 1};
    expect_no_shape(object, NULL, "plane: normal");
    object.normal = (ps_vec3){0, NAN, 1};
    expect_no_shape(object, NULL, "plane: normal");
    object.normal = (ps_vec3){0, 1, 0};
    object.distance = 1e300;
    expect_no_shape(object, NULL, "distance");
    object.distance = 0;
    object.extent = -1;
    expect_no_shape(object, NULL, "extent");
}

/* Rows from the top, as in a picture: 3 wide, 2 high. */
static const float picture[2 * 3] = {0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 0.125f};

static struct shape field_of(size_t width, size_t height, const float *samples, bool smooth,
                             struct affine placement)
{
    const struct height_samples heights = {width, height, samples};
    const struct shape_surroundings around = {.heights = &heights};
    return shape_of((struct object_description){.kind = OBJECT_HEIGHT_FIELD,
                                                .smooth = smooth,
                                                .placement = placement},
                    &around);
}

/* The lower left pixel is at x = 0, z = 0; x goes along rows, z up the picture. */
static void test_height_field_lies_as_in_pov_ray(void **state)
{
    (void)state;
    struct shape shape = field_of(3, 2, picture, false, (struct affine)AFFINE_IDENTITY);
    double sum[3];
    assert_int_equal(shape.vertex_count, 6);
    assert_int_equal(shape.triangle_count, 4);
    assert_null(shape.normals);
    expect_vector(shape.vertices[0], 0, 0.75, 0);
    expect_vector(shape.vertices[1], 0.5, 1, 0);
    expect_vector(shape.vertices[2], 1, 0.125, 0);
    expect_vector(shape.vertices[3], 0, 0, 1);
    expect_vector(shape.vertices[5], 1, 0.5, 1);
    for (int i = 0; i < 6; i++)
        assert_true(shape.uv[i][0] == shape.vertices[i].x && shape.uv[i][1] == shape.vertices[i].z);
    mesh_area_vector(&shape, sum);
    expect_near(sum[1], 1, 1e-6); /* the front is up, all over the unit square */
    expect_good_uv(&shape, -1);
    shape_release(&shape);
    shape = field_of(3, 2, picture, false, sheared_mirror);
    mesh_area_vector(&shape, sum);
    assert_true(sum[1] > 0);
    expect_good_uv(&shape, 1);
    shape_release(&shape);
}

/* A wave: y = (1 + sin(2 pi x)) / 4, n across it. */
static void test_smooth_normals(void **state)
{
    (void)state;
    const size_t n = 65;
    float *samples = calloc(n * n, sizeof *samples);
    assert_non_null(samples);
    for (size_t i = 0; i < n * n; i++)
        samples[i] = 0.25f + 0.25f * sinf(2 * PS_PI * (float)(i % n) / (float)(n - 1));
    struct shape shape = field_of(n, n, samples, true, (struct affine)AFFINE_IDENTITY);
    expect_good_normals(&shape);
    for (size_t i = 0; i < n * n; i++) {
        size_t column = i % n;
        double slope = 0.5 * PI * cos(2 * PI * (double)column / (double)(n - 1));
        ps_vec3 normal = shape.normals[i];
        bool border = column == 0 || column == n - 1;
        double size = hypot(slope, 1), dot = (-slope * (double)normal.x + (double)normal.y) / size;
        assert_true(dot > (border ? 0.998 : 0.9999));
        assert_true(fabsf(normal.z) < 0.01f);
    }
    shape_release(&shape);
    shape = field_of(n, n, samples, true, sheared_mirror);
    expect_good_normals(&shape);
    shape_release(&shape);
    free(samples);
}

static void test_no_height_field(void **state)
{
    (void)state;
    float bad[4] = {0, 0, NAN, 0};
    const struct object_description object = {.kind = OBJECT_HEIGHT_FIELD};
    struct height_samples heights = {1, 4, picture};
    const struct shape_surroundings around = {.heights = &heights};
    expect_no_shape(object, NULL, "height_field: it has no picture");
    expect_no_shape(object, &around, "2 pixels");
    heights = (struct height_samples){2, 2, bad};
    expect_no_shape(object, &around, "no number");
    heights = (struct height_samples){(size_t)1 << 14, ((size_t)1 << 13) + 1, picture};
    expect_no_shape(object, &around, "2^27");
    heights = (struct height_samples){SIZE_MAX / 2, SIZE_MAX / 2, picture};
    expect_no_shape(object, &around, "2^27");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane_of_stated_extent),
        cmocka_unit_test(test_plane_reaches_around_the_rest),
        cmocka_unit_test(test_plane_below_all),
        cmocka_unit_test(test_no_plane),
        cmocka_unit_test(test_height_field_lies_as_in_pov_ray),
        cmocka_unit_test(test_smooth_normals),
        cmocka_unit_test(test_no_height_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
