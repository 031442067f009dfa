/* test_mesh_smooth_angle.c: normals of parts that have none, by the angle of their edges. */
#include "mesh_fixture.h"

/* Of both signs along each axis; each face is cut along one diagonal. */
#define CUBE                                                                                       \
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"         \
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6\n"

/* Two faces that meet in the edge 2-3 at a right angle. */
#define ROOF "v -1 0 0\nv 0 1 0\nv 0 1 -1\nv 1 0 0\n"

static struct imported import_smooth(const char *path, const char *text, double degrees)
{
    struct mesh_request request = request_all(path);
    struct mesh_memory_file file = text_file(path, text);
    request.smooth_angle = degrees;
    struct imported imported = import_files(&request, &file, 1);
    expect_success(&imported);
    return imported;
}

static const struct mesh_description *only_mesh(const struct imported *imported)
{
    assert_int_equal(imported->fragment.object_count, 1);
    return mesh_of(imported, 0);
}

/* Of a corner. */
static ps_vec3 normal_of(const struct mesh_description *mesh, size_t triangle, int k)
{
    assert_non_null(mesh->normals);
    return ps_normalize(mesh->normals[mesh->triangles[triangle][k]]);
}

static void expect_flat(const struct imported *imported)
{
    const struct mesh_description *mesh = only_mesh(imported);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            assert_true(ps_dot(normal_of(mesh, i, k), front_of(imported, 0, i)) > 0.99999f);
}

/* All three faces of a corner count alike, though they have one or two triangles there. */
static void a_cube_is_sharp_or_round(void **state)
{
    (void)state;
    struct imported imported = import_smooth("m.obj", CUBE, 89);
    expect_flat(&imported);
    release_imported(&imported);
    imported = import_smooth("m.obj", CUBE, 90);
    const struct mesh_description *mesh = only_mesh(&imported);
    assert_int_equal(mesh->triangle_count, 12);
    for (size_t i = 0; i < 12; i++)
        for (int k = 0; k < 3; k++) {
            ps_vec3 at = ps_normalize(mesh->vertices[mesh->triangles[i][k]]);
            expect_vector(normal_of(mesh, i, k), at.x, at.y, at.z);
        }
    release_imported(&imported);
}

static void zero_leaves_parts_flat(void **state)
{
    (void)state;
    struct imported imported = import_smooth("m.obj", CUBE, 0);
    assert_null(only_mesh(&imported)->normals);
    release_imported(&imported);
}

/* A strip of three faces, bent by 40 and then by 80 degrees; PLY's faces share vertices. */
static void vertices_are_split_at_sharp_edges(void **state)
{
    static const char strip[] =
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty "
        "float z\n"
        "property float s\nproperty float t\n"
        "element face 3\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 0 0\n0 0 -1 0 1\n1 0 0 1 0\n1 0 -1 1 1\n1.7660444 0.6427876 0 2 0\n1.7660444 "
        "0.6427876 -1 2 1\n"
        "1.2660444 1.5088130 0 3 0\n1.2660444 1.5088130 -1 3 1\n"
        "4 0 2 3 1\n4 2 4 5 3\n4 4 6 7 5\n";
    (void)state;
    struct imported imported = import_smooth("m.ply", strip, 60);
    const struct mesh_description *mesh = only_mesh(&imported);
    assert_int_equal(mesh->triangle_count, 6);
    const double half = 20 * M_PI / 180;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh->triangles[i][k];
            ps_vec3 n = normal_of(mesh, i, k), front = front_of(&imported, 0, i);
            float u = mesh->uv[vertex][0];
            if (u == 1) /* between the first two faces */
                expect_vector(n, -sin(half), cos(half), 0);
            else
                expect_vector(n, front.x, front.y, front.z);
            /* Coordinates go with the vertices. */
            expect_near(mesh->uv[vertex][1], -mesh->vertices[vertex].z, 1e-6);
            if (u <= 1)
                expect_near(mesh->vertices[vertex].x, u, 1e-6);
        }
    release_imported(&imported);
}

static void odd_edges_are_sharp(void **state)
{
    (void)state;
    /* Of three faces; and of two that face different sides. */
    struct imported imported =
        import_smooth("m.obj", ROOF "v 0 2 0\nf 1 2 3\nf 3 2 4\nf 2 3 5\n", 180);
    expect_flat(&imported);
    release_imported(&imported);
    imported = import_smooth("m.obj", ROOF "f 1 2 3\nf 2 3 4\n", 180);
    expect_flat(&imported);
    release_imported(&imported);
    imported = import_smooth("m.obj", ROOF "f 1 2 3\nf 3 2 4\n", 180);
    expect_near(normal_of(only_mesh(&imported), 0, 1).x, 0, 1e-6);
    release_imported(&imported);
}

static void what_the_file_says_counts(void **state)
{
    (void)state;
    struct imported imported =
        import_smooth("m.obj", ROOF "vn 1 0 0\nf 1//1 2//1 3//1\nf 3//1 2//1 4//1\n", 180);
    expect_vector(normal_of(only_mesh(&imported), 0, 1), 1, 0, 0);
    release_imported(&imported);
    imported = import_smooth("m.obj", ROOF "s 1\nf 1 2 3\ns 2\nf 3 2 4\n", 180);
    expect_flat(&imported);
    release_imported(&imported);
    /* Groups that are off are none. */
    imported = import_smooth("m.obj", ROOF "s off\nf 1 2 3\nf 3 2 4\n", 180);
    expect_near(normal_of(only_mesh(&imported), 0, 1).x, 0, 1e-6);
    release_imported(&imported);
}

static void stl_becomes_smooth(void **state)
{
    (void)state;
    struct imported imported = import_smooth(
        "m.stl",
        "solid s\nfacet normal 0 0 0\nouter loop\nvertex -1 0 0\nvertex 0 1 0\nvertex 0 1 -1\n"
        "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 1 -1\nvertex 0 1 0\n"
        "vertex 1 0 0\nendloop\nendfacet\nendsolid s\n",
        100);
    const struct mesh_description *mesh = only_mesh(&imported);
    expect_near(normal_of(mesh, 0, 1).x, 0, 1e-6);
    expect_near(normal_of(mesh, 1, 1).x, 0, 1e-6);
    release_imported(&imported);
}

static void senseless_angles_are_refused(void **state)
{
    static const double angles[] = {-1, 181, NAN};
    struct mesh_memory_file file = text_file("m.obj", CUBE);
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        struct mesh_request request = request_all("m.obj");
        request.smooth_angle = angles[i];
        struct imported imported = import_files(&request, &file, 1);
        expect_failure(&imported, PS_ERROR_INVALID, "angle");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_sharp_or_round),
        cmocka_unit_test(zero_leaves_parts_flat),
        cmocka_unit_test(vertices_are_split_at_sharp_edges),
        cmocka_unit_test(odd_edges_are_sharp),
        cmocka_unit_test(what_the_file_says_counts),
        cmocka_unit_test(stl_becomes_smooth),
        cmocka_unit_test(senseless_angles_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
