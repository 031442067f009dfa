/* test_parser_objects.c: objects, placements and groups of scenes, right and wrong. */
#include "parser_fixture.h"

#include <math.h>
#include <stdlib.h>

/* What follows is the list of objects and starts on line 6. */
#define OBJECTS HEAD "objects:\n"

static void assert_near(ps_vec3 v, double x, double y, double z)
{
    if (fabs(v.x - x) + fabs(v.y - y) + fabs(v.z - z) > 1e-5)
        fail_msg("(%g, %g, %g), expected (%g, %g, %g)", v.x, v.y, v.z, x, y, z);
}

static void test_shapes(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        OBJECTS
        "  - cylinder: {from: [0, 0, 0], to: [0, 1, 0], radius: 2, open: yes, material: white}\n"
        "  - cone: {from: [0, 0, 0], from_radius: 1, to: [0, 3, 0], to_radius: 0,\n"
        "           segments: 9, material: white, camera: no}\n"
        "  - disc: {center: [1, 2, 3], normal: [0, 2, 0], radius: 2, hole: 1, material: white}\n"
        "  - plane: {normal: [0, 0, -5], distance: 4, material: white}\n"
        "  - plane: {normal: [0, 1, 0], extent: 7, material: white}\n"
        "  - torus: {radius: 2, minor_radius: 0.5, material: white}\n"
        "  - height_field: {file: h.png, material: white}\n"
        "  - sphere: {center: [0, 0, 0], radius: 1, material: white, scale: [1, 2, 3]}\n");
    const struct object_description *o = d.objects;
    assert_int_equal(d.object_count, 8);
    assert_int_equal(o[0].kind, OBJECT_CYLINDER);
    assert_true(o[0].points[1].y == 1 && o[0].radius == 2 && o[0].open && o[0].segments == 64);
    assert_int_equal(o[1].kind, OBJECT_CONE);
    assert_true(o[1].radius == 1 && o[1].to_radius == 0 && o[1].points[1].y == 3 && !o[1].open);
    assert_true(o[1].segments == 9 && o[1].hidden && !o[0].hidden);
    assert_int_equal(o[2].kind, OBJECT_DISC);
    assert_near(o[2].normal, 0, 1, 0);
    assert_true(o[2].center.z == 3 && o[2].hole_radius == 1);
    assert_int_equal(o[3].kind, OBJECT_PLANE);
    assert_near(o[3].normal, 0, 0, -1);
    assert_true(o[3].distance == 4 && o[3].extent == 0 && o[4].extent == 7);
    assert_int_equal(o[5].kind, OBJECT_TORUS);
    assert_true(o[5].radius == 2 && o[5].minor_radius == 0.5);
    assert_int_equal(o[6].kind, OBJECT_HEIGHT_FIELD);
    assert_true(o[6].smooth && d.textures[o[6].texture].encoding == ENCODING_LINEAR);
    assert_near(o[7].placement.z, 0, 0, 3);
    for (size_t i = 0; i < d.object_count; i++)
        assert_true(o[i].mesh == NO_INDEX && o[i].group == NO_INDEX && o[i].origin.line > 5);
    scene_description_release(&d);
}

static void test_triangles(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        OBJECTS
        "  - triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]],\n"
        "                normals: [[0, 0, 1], [0, 0, 2], [0, 1, 1]],\n"
        "                uv: [[0, 0], [1, 0], [0, 0.5]], material: white}\n"
        "  - triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]],\n"
        "                material: white}\n");
    assert_int_equal(d.objects[0].kind, OBJECT_MESH);
    assert_int_equal(d.objects[1].kind, OBJECT_TRIANGLES);
    assert_int_equal(d.mesh_count, 1);
    const struct mesh_description *mesh = &d.meshes[d.objects[0].mesh];
    assert_int_equal(mesh->vertex_count, 3);
    assert_int_equal(mesh->triangle_count, 1);
    assert_int_equal(mesh->triangles[0][2], 2);
    assert_true(mesh->normals[1].z == 2 && mesh->uv[2][1] == 0.5F);
    assert_null(d.objects[0].vertices);
    scene_description_release(&d);
}

/* Where the placement of a sphere with these keys carries (1, 2, 3). */
static ps_vec3 placed(const char *keys)
{
    char text[1024];
    snprintf(text, sizeof text,
             OBJECTS "  - sphere: {center: [0, 0, 0], radius: 1, material: white, %s}\n", keys);
    struct scene_description d = parse_good(text);
    ps_vec3 p = affine_point(&d.objects[0].placement, (ps_vec3){1, 2, 3});
    scene_description_release(&d);
    return p;
}

static void test_placements(void **state)
{
    (void)state;
    assert_near(placed("translate: [10, 20, 30], scale: 2"), 12, 24, 36);
    assert_near(placed("matrix: [0, 1, 0, 5, 2, 0, 0, 6, 0, 0, -1, 7]"), 7, 8, 4);
    assert_near(placed("look_at: {from: [5, 0, 0], to: [9, 0, 0]}"), 8, 2, -1);
    assert_near(placed("look_at: {from: [0, 0, 0], to: [0, 5, 0], up: [0, 0, 1]}"), -1, 3, 2);
    assert_near(placed("transform: [translate: [1, 0, 0], scale: 2, rotate: [0, 0, 90]]"), -4, 4,
                6);
    assert_near(placed("transform: [rotate: [0, 0, 90], matrix: [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, "
                       "0], look_at: {from: [0, 0, 0], to: [0, 0, -1]}]"),
                1, 1, -3);
    assert_near(placed("transform: []"), 1, 2, 3);
}

static void test_wrong_placements(void **state)
{
    (void)state;
#define SPHERE "  - sphere: {center: [0, 0, 0], radius: 1, material: white, "
    static const struct bad cases[] = {
        {OBJECTS SPHERE "matrix: [1, 2, 3]}\n" SPHERE
                        "matrix: [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0]}\n" SPHERE
                        "matrix: [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, x]}\n" SPHERE
                        "matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], scale: 2}\n" SPHERE
                        "scale: [1e-40, 1e-40, 1e-40]}\n",
         "6:69: error: matrix in sphere: expected a list of 12 numbers, got 3\n"
         "7:69: error: the matrix is singular: it has no inverse\n"
         "8:103: error: matrix in sphere: expected a number, got 'x'\n"
         "9:69: error: sphere has both scale and matrix; give one of them\n"
         "10:68: error: the transform is singular: it has no inverse\n"},
        /* the last row is the sum of the others, but not in floats */
        {OBJECTS SPHERE "matrix: [0.1, 0.2, 0.7, 0, 0.3, 0.1, 0.9, 0, 0.4, 0.3, 1.6, 0]}\n",
         "6:69: error: the matrix is singular: it has no inverse\n"},
        {OBJECTS SPHERE "look_at: {from: [0, 0, 0], to: [0, 0, 0]}}\n" SPHERE
                        "look_at: {from: [0, 0, 0], to: [0, 1, 0]}}\n" SPHERE
                        "look_at: {form: 5}}\n",
         "6:92: error: to in look_at is the same as from; it must be another point\n"
         "7:61: error: up in look_at is along the way from 'from' to 'to'\n"
         "8:61: error: missing key 'from' in look_at\n"
         "8:61: error: missing key 'to' in look_at\n"
         "8:71: error: unknown key 'form' in look_at; did you mean 'from'?\n"},
        {OBJECTS SPHERE "transform: 5}\n" SPHERE
                        "transform: [5, {}, {scale: 0}, {skale: 1}]}\n" SPHERE
                        "transform: [{scale: 1, rotate: [0, 0, 0]}], translate: [0, 0, 0]}\n",
         "6:72: error: expected a list for transform, got text\n"
         "7:73: error: expected a map with one key in transform, got text\n"
         "7:76: error: expected a map with one key in transform, got another number of keys\n"
         "7:88: error: a factor of scale is 0\n"
         "7:93: error: unknown key 'skale' in transform; did you mean 'scale'?\n"
         "8:72: error: sphere has both translate and transform; give one of them\n"}};
    EXPECT_ALL(cases);
}

static void test_wrong_shapes(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {OBJECTS
         "  - cylinder: {from: [0, 0, 0], to: [0, 0, 0], radius: 2, material: white}\n"
         "  - cone: {from: [0, 0, 0], to: [0, 1, 0], from_radius: 0, to_radius: 0, material: "
         "white}\n"
         "  - disc: {center: [1, 2, 3], normal: [0, 0, 0], radius: 2, hole: 2, material: "
         "white}\n"
         "  - plane: {normal: [0, 0, 0], extent: far, material: white}\n"
         "  - plane: {normal: [0, 0, 0], material: white}\n"
         "  - torus: {radius: 1, minor_radius: 1, segments: 2.5, material: white}\n"
         "  - torus: {radius: 1, minor_radius: 1, material: white}\n"
         "  - height_field: {material: white, smooth: 5}\n",
         "6:37: error: its two ends are at the same point\n"
         "7:71: error: both radii of the cone are 0\n"
         "8:39: error: the length of normal is 0\n"
         "8:67: error: the hole is as large as the disc\n"
         "9:40: error: extent in plane: expected auto | number > 0, got 'far'\n"
         "10:21: error: the length of normal is 0\n"
         "11:51: error: segments in torus: expected integer 3..8192, got '2.5'\n"
         "12:38: error: minor_radius must be smaller than radius\n"
         "13:5: error: missing key 'file' in height_field\n"
         "13:45: error: smooth in height_field: expected yes | no, got '5'\n"},
        {OBJECTS
         "  - triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]], material: "
         "white,\n"
         "                triangles: [[0, 1, 2]], normals: [[0, 1, 0], [0, 0, 0], [1, 1, 1]],\n"
         "                uv: [[0, 0], [0, 0], [0, 0], [0, 0], [0, 0]]}\n"
         "  - triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], material: white,\n"
         "                triangles: [[0, 1, 2]], uv: [[0, 0], [0], 5]}\n",
         "7:50: error: normals in triangles: expected one for each of 4 vertices, got 3\n"
         "7:62: error: the length of this normal is 0\n"
         "8:21: error: uv in triangles: expected one for each of 4 vertices, got 5\n"
         "10:54: error: uv in triangles: expected 2 numbers, got 1\n"
         "10:59: error: uv in triangles: expected [u, v], got text\n"}};
    EXPECT_ALL(cases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes),       cmocka_unit_test(test_triangles),
        cmocka_unit_test(test_placements),   cmocka_unit_test(test_wrong_placements),
        cmocka_unit_test(test_wrong_shapes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
