/* test_mesh_geometry.c: vertices, normals, texture coordinates and placement, by format. */
#include "mesh_fixture.h"

/* --- axes and units --------------------------------------------------------------------------- */

static const char three_axes[] = "v 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 2 3\n";

static struct imported import_turned(int up, double unit)
{
    struct mesh_request request = request_all("m.obj");
    struct mesh_memory_file file = text_file("m.obj", three_axes);
    request.up = up;
    request.unit = unit;
    struct imported imported = import_files(&request, &file, 1);
    expect_success(&imported);
    return imported;
}

static void axis_that_points_up_becomes_y(void **state)
{
    (void)state;
    struct imported imported = import_turned(1, 1);
    expect_vector(corner(&imported, 0, 0, 0), 1, 0, 0);
    expect_vector(corner(&imported, 0, 0, 1), 0, 2, 0);
    expect_vector(corner(&imported, 0, 0, 2), 0, 0, 3);
    release_imported(&imported);
    imported = import_turned(2, 10); /* Blender's */
    expect_vector(corner(&imported, 0, 0, 0), 10, 0, 0);
    expect_vector(corner(&imported, 0, 0, 1), 0, 0, -20);
    expect_vector(corner(&imported, 0, 0, 2), 0, 30, 0);
    release_imported(&imported);
    imported = import_turned(0, 0.5);
    expect_vector(corner(&imported, 0, 0, 0), 0, 0.5, 0);
    expect_vector(corner(&imported, 0, 0, 1), -1, 0, 0);
    expect_vector(corner(&imported, 0, 0, 2), 0, 0, 1.5);
    release_imported(&imported);
}

static void placement_comes_last(void **state)
{
    (void)state;
    struct mesh_request request = request_all("m.obj");
    struct mesh_memory_file file = text_file("m.obj", three_axes);
    request.up = 2;
    request.unit = 10;
    request.placement = (struct affine){{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 7}}; /* mirrors */
    struct imported imported = import_files(&request, &file, 1);
    expect_success(&imported);
    ps_vec3 front = front_of(&imported, 0, 0); /* that of the file, carried along */
    ps_vec3 file_front = ps_normalize((ps_vec3){6, 3, 2});
    expect_vector(front, file_front.z, file_front.x, -file_front.y);
    release_imported(&imported);
    imported = import_files(&request, &file, 1);
    ps_vec3 sum = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        sum = ps_add(sum, corner(&imported, 0, 0, k));
    expect_vector(sum, 30, 10, -20 + 3 * 7);
    release_imported(&imported);
}

static void senseless_requests_are_refused(void **state)
{
    (void)state;
    struct mesh_memory_file file = text_file("m.obj", three_axes);
    struct mesh_request request = request_all("m.obj");
    request.unit = 0;
    struct imported imported = import_files(&request, &file, 1);
    expect_failure(&imported, PS_ERROR_INVALID, "unit");
    request.unit = NAN;
    imported = import_files(&request, &file, 1);
    expect_failure(&imported, PS_ERROR_INVALID, "unit");
    request = request_all("m.obj");
    request.up = 3;
    imported = import_files(&request, &file, 1);
    expect_failure(&imported, PS_ERROR_INVALID, "axis");
    request = request_all("m.obj");
    request.placement.y = (ps_vec3){0, 0, 0};
    imported = import_files(&request, &file, 1);
    expect_failure(&imported, PS_ERROR_INVALID, "scale of 0");
}

/* --- OBJ -------------------------------------------------------------------------------------- */

static void polygons_are_split(void **state)
{
    (void)state;
    struct imported imported = import_text(
        "m.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
    expect_success(&imported);
    double area = 0; /* of an L */
    for (size_t i = 0; i < mesh_of(&imported, 0)->triangle_count; i++) {
        ps_vec3 a = corner(&imported, 0, i, 0);
        area += 0.5 * ps_cross(ps_subtract(corner(&imported, 0, i, 1), a),
                               ps_subtract(corner(&imported, 0, i, 2), a))
                          .z;
    }
    expect_near(area, 3, 1e-6);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 4);
    release_imported(&imported);
}

static void texture_coordinates_grow_upwards(void **state)
{
    (void)state;
    struct imported imported = import_text(
        "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0.5\nvt 0 0.875\nf 1/1 2/2 3/3\n");
    expect_success(&imported);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    static const float expected[3][2] = {{0, 0.25f}, {1, 0.5f}, {0, 0.875f}};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++)
            expect_near(mesh->uv[mesh->triangles[0][k]][i], expected[k][i], 1e-6);
    assert_null(mesh->normals);
    release_imported(&imported);
}

static void normals_of_the_file_are_kept(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 0 3 0\nvn 0 0 1\n"
                             "s off\nf 1//1 2//2 3//3\n");
    expect_success(&imported);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_non_null(mesh->normals);
    expect_vector(ps_normalize(mesh->normals[mesh->triangles[0][0]]), 1, 0, 0);
    expect_vector(ps_normalize(mesh->normals[mesh->triangles[0][1]]), 0, 1, 0);
    expect_vector(ps_normalize(mesh->normals[mesh->triangles[0][2]]), 0, 0, 1);
    release_imported(&imported);
    imported = import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn nan 0 0\nvn 1 0 0\n"
                                    "f 1//1 2//2 3//3\n");
    expect_success(&imported);
    mesh = mesh_of(&imported, 0); /* what is no normal becomes the triangle's */
    expect_vector(ps_normalize(mesh->normals[mesh->triangles[0][0]]), 0, 0, 1);
    expect_vector(ps_normalize(mesh->normals[mesh->triangles[0][1]]), 0, 0, 1);
    expect_vector(ps_normalize(mesh->normals[mesh->triangles[0][2]]), 1, 0, 0);
    release_imported(&imported);
}

/* A roof of two faces that meet in the edge 2-3, at a right angle. */
#define ROOF "v -1 0 0\nv 0 1 0\nv 0 1 -1\nv 1 0 0\n"

static ps_vec3 normal_at(const struct imported *imported, size_t object, size_t triangle, int k)
{
    const struct mesh_description *mesh = mesh_of(imported, object);
    assert_non_null(mesh->normals);
    return ps_normalize(mesh->normals[mesh->triangles[triangle][k]]);
}

static void smoothing_group_smooths_within_itself(void **state)
{
    (void)state;
    const double h = sqrt(0.5);
    struct imported imported = import_text("m.obj", ROOF "s 1\nf 1 2 3\nf 3 2 4\n");
    expect_success(&imported);
    ps_vec3 side = normal_at(&imported, 0, 0, 0), ridge = normal_at(&imported, 0, 0, 1);
    expect_vector(side, front_of(&imported, 0, 0).x, front_of(&imported, 0, 0).y,
                  front_of(&imported, 0, 0).z);
    expect_near(fabs(ridge.y), 1, 1e-6); /* between the two, which lean by 45 degrees */
    expect_near(fabs(side.y), h, 1e-6);
    release_imported(&imported);
    imported = import_text("m.obj", ROOF "s 1\nf 1 2 3\ns 2\nf 3 2 4\n"); /* a crease */
    expect_near(fabs(normal_at(&imported, 0, 0, 1).y), h, 1e-6);
    release_imported(&imported);
    imported = import_text("m.obj", ROOF "s 1\nf 1 2 3\ns off\nf 3 2 4\n");
    expect_near(fabs(normal_at(&imported, 0, 0, 1).y), h, 1e-6);
    expect_near(fabs(normal_at(&imported, 0, 1, 1).y), h, 1e-6);
    release_imported(&imported);
    imported = import_text("m.obj", ROOF "s off\nf 1 2 3\nf 3 2 4\n");
    assert_null(mesh_of(&imported, 0)->normals);
    release_imported(&imported);
}

static void smoothing_goes_across_materials_and_relative_indices(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", ROOF "s 1\nusemtl a\nf -4 -3 -2\nusemtl b\nf -2 -3 4\n");
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 2);
    expect_near(fabs(normal_at(&imported, 0, 0, 1).y), 1, 1e-6);
    expect_near(fabs(normal_at(&imported, 1, 0, 1).y), 1, 1e-6);
    release_imported(&imported);
}

/* --- other formats ---------------------------------------------------------------------------- */

/* The first number begins like the end of a line. */
static void data_of_ply_are_no_header(void **state)
{
    static const char header[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
        "y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    static const unsigned char ends[] = {'\n', '\r'};
    (void)state;
    for (int i = 0; i < 2; i++) {
        char file[sizeof header - 1 + 36 + 13] = {0};
        char *data = file + sizeof header - 1;
        memcpy(file, header, sizeof header - 1);
        memcpy(data, (unsigned char[]){ends[i], 0, 0x80, 0x3f}, 4); /* 1.000001 */
        memcpy(data + 16, (unsigned char[]){0, 0, 0, 0x40}, 4);     /* 2 */
        memcpy(data + 36, (unsigned char[]){3, 0, 0, 0, 0, 1, 0, 0, 0, 2}, 10);
        const struct mesh_memory_file files[] = {{"m.ply", file, sizeof file}};
        struct mesh_request request = request_all("m.ply");
        struct imported imported = import_files(&request, files, 1);
        expect_success(&imported);
        const struct mesh_description *mesh = mesh_of(&imported, 0);
        assert_int_equal(mesh->triangle_count, 1);
        expect_vector(mesh->vertices[mesh->triangles[0][0]], 1, 0, 0);
        expect_vector(mesh->vertices[mesh->triangles[0][1]], 0, 2, 0);
        release_imported(&imported);
    }
}

static void ply_is_read(void **state)
{
    (void)state;
    struct imported imported =
        import_text("M.PLY", "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\n"
                             "property float y\r\nproperty float z\r\nelement face 1\r\n"
                             "property list uchar int vertex_indices\r\nend_header\r\n"
                             "0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3\r\n");
    expect_success(&imported);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 2);
    expect_vector(front_of(&imported, 0, 0), 0, 0, 1);
    assert_int_equal(imported.fragment.material_count, 0);
    assert_true(imported.fragment.objects[0].material == NO_INDEX);
    release_imported(&imported);
}

static void stl_is_flat(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.stl", "solid s\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\n"
                             "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n");
    expect_success(&imported);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 1);
    assert_null(mesh_of(&imported, 0)->normals);
    assert_int_equal(imported.fragment.material_count, 0);
    release_imported(&imported);
}

static void import_is_repeatable(void **state)
{
    (void)state;
    struct imported a = import_text("m.obj", ROOF "s 1\nf 1 2 3\nf 3 2 4\n");
    struct imported b = import_text("m.obj", ROOF "s 1\nf 1 2 3\nf 3 2 4\n");
    const struct mesh_description *p = mesh_of(&a, 0), *q = mesh_of(&b, 0);
    assert_int_equal(p->vertex_count, q->vertex_count);
    assert_memory_equal(p->vertices, q->vertices, p->vertex_count * sizeof *p->vertices);
    assert_memory_equal(p->normals, q->normals, p->vertex_count * sizeof *p->normals);
    assert_memory_equal(p->triangles, q->triangles, p->triangle_count * sizeof *p->triangles);
    release_imported(&a);
    release_imported(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axis_that_points_up_becomes_y),
        cmocka_unit_test(placement_comes_last),
        cmocka_unit_test(senseless_requests_are_refused),
        cmocka_unit_test(polygons_are_split),
        cmocka_unit_test(texture_coordinates_grow_upwards),
        cmocka_unit_test(normals_of_the_file_are_kept),
        cmocka_unit_test(smoothing_group_smooths_within_itself),
        cmocka_unit_test(smoothing_goes_across_materials_and_relative_indices),
        cmocka_unit_test(ply_is_read),
        cmocka_unit_test(data_of_ply_are_no_header),
        cmocka_unit_test(stl_is_flat),
        cmocka_unit_test(import_is_repeatable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
