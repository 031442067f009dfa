/* test_mesh_ply.c: PLY files: binary ones, with numbers of all types and either order of bytes, and
 * texts. */
#include "mesh_fixture.h"

/* A file that is being written. */
struct writing {
    unsigned char bytes[4096];
    size_t length;
    int big_endian;
};

static struct writing begin(int big_endian, const char *elements)
{
    struct writing file = {.big_endian = big_endian};
    int length = snprintf((char *)file.bytes, sizeof file.bytes,
                          "ply\nformat binary_%s_endian 1.0\ncomment made by hand\n%send_header\n",
                          big_endian ? "big" : "little", elements);
    file.length = (size_t)length;
    return file;
}

static void put(struct writing *file, uint64_t bits, size_t size)
{
    for (size_t i = 0; i < size; i++)
        file->bytes[file->length++] =
            (unsigned char)(bits >> 8 * (file->big_endian ? size - 1 - i : i));
}

static void put_float(struct writing *file, float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    put(file, bits, 4);
}

static void put_double(struct writing *file, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    put(file, bits, 8);
}

static void put_place(struct writing *file, float x, float y, float z)
{
    put_float(file, x);
    put_float(file, y);
    put_float(file, z);
}

static struct imported import_bytes(const unsigned char *bytes, size_t length)
{
    const struct mesh_memory_file files[] = {{"m.ply", bytes, length},
                                             {"a.png", PNG_START, sizeof PNG_START}};
    struct mesh_request request = request_all("m.ply");
    return import_files(&request, files, 2);
}

static struct imported import_written(const struct writing *file)
{
    return import_bytes(file->bytes, file->length);
}

#define PLACES "property float x\nproperty float y\nproperty float32 z\n"
#define FACES(N) "element face " #N "\nproperty list uchar int vertex_indices\n"

static void put_square(struct writing *file)
{
    put_place(file, 0, 0, 0);
    put_place(file, 1, 0, 0);
    put_place(file, 1, 1, 0);
    put_place(file, 0, 1, 0.5f);
}

static void numbers_of_all_types(void **state)
{
    (void)state;
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        struct writing file = begin(
            big_endian, "element vertex 4\nproperty double x\nproperty short y\nproperty char z\n"
                        "property uint mark\nproperty float quality\n"
                        "element face 2\nproperty ushort group\n"
                        "property list int uint16 vertex_index\nproperty double area\n");
        const int places[][3] = {{0, 0, 0}, {1000, 0, -5}, {1000, -300, 0}, {0, 300, 7}};
        for (int i = 0; i < 4; i++) {
            put_double(&file, places[i][0] + 0.25);
            put(&file, (uint16_t)places[i][1], 2);
            put(&file, (uint8_t)places[i][2], 1);
            put(&file, 0xdeadbeef, 4);
            put_float(&file, 0.5f);
        }
        for (unsigned i = 0; i < 2; i++) {
            put(&file, 7, 2);
            put(&file, 3, 4);
            put(&file, 0, 2);
            put(&file, 1 + i, 2);
            put(&file, 2 + i, 2);
            put_double(&file, 1);
        }
        struct imported imported = import_written(&file);
        expect_success(&imported);
        const struct mesh_description *mesh = mesh_of(&imported, 0);
        assert_int_equal(mesh->vertex_count, 4);
        assert_int_equal(mesh->triangle_count, 2);
        expect_vector(mesh->vertices[1], 1000.25, 0, -5);
        expect_vector(mesh->vertices[2], 1000.25, -300, 0);
        expect_vector(mesh->vertices[3], 0.25, 300, 7);
        assert_int_equal(mesh->triangles[1][2], 3);
        assert_null(mesh->normals);
        assert_null(mesh->uv);
        release_imported(&imported);
    }
}

static void normals_coordinates_and_colours(void **state)
{
    (void)state;
    struct writing file =
        begin(0, "comment TextureFile a.png\nelement vertex 4\n" PLACES
                 "property float nx\nproperty float ny\nproperty float nz\n"
                 "property float s\nproperty float t\n"
                 "property uchar red\nproperty uchar green\nproperty uchar blue\n" FACES(1));
    for (int i = 0; i < 4; i++) {
        put_place(&file, i == 1 || i == 2, i >= 2, 0);
        put_place(&file, 0, 0, -1);
        put_float(&file, 0.25f * (float)i);
        put_float(&file, 0.75f);
        put(&file, 255, 1);
        put(&file, 188, 1);
        put(&file, 0, 1);
    }
    put(&file, 4, 1);
    for (unsigned i = 0; i < 4; i++)
        put(&file, i, 4);
    struct imported imported = import_written(&file);
    expect_success(&imported);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_int_equal(mesh->triangle_count, 2);
    expect_vector(mesh->normals[2], 0, 0, -1);
    expect_near(mesh->uv[3][0], 0.75, 0);
    expect_near(mesh->uv[3][1], 0.75, 0);
    expect_near(mesh->colors[0][0], 1, 1e-6);
    expect_near(mesh->colors[0][1], 0.5029, 1e-3);
    expect_near(mesh->colors[0][2], 0, 0);
    assert_int_equal(imported.fragment.texture_count, 1);
    assert_string_equal(imported.fragment.textures[0].path, "a.png");
    size_t material = imported.fragment.objects[0].material;
    assert_int_equal(imported.fragment.materials[material].color.texture, 0);
    assert_true(imported.fragment.materials[material].color.vertex_colors);
    release_imported(&imported);
}

/* Wide and floating colours, and an alpha, which is told. */
static void colours_of_other_types(void **state)
{
    (void)state;
    struct writing file =
        begin(1, "element vertex 3\n" PLACES "property ushort r\nproperty float g\n"
                 "property double b\nproperty uchar alpha\n" FACES(1));
    for (int i = 0; i < 3; i++) {
        put_place(&file, i == 1, i == 2, 0);
        put(&file, 65535, 2);
        put_float(&file, 0);
        put_double(&file, 1);
        put(&file, 128, 1);
    }
    put(&file, 3, 1);
    for (unsigned i = 0; i < 3; i++)
        put(&file, i, 4);
    struct imported imported = import_written(&file);
    expect_success(&imported);
    const float *color = mesh_of(&imported, 0)->colors[1];
    expect_near(color[0], 1, 1e-6);
    expect_near(color[1], 0, 0);
    expect_near(color[2], 1, 1e-6);
    expect_near(color[3], 1, 0);
    assert_string_equal(imported.report.notes, "the alpha of vertex colours is left out");
    release_imported(&imported);
}

/* A dart: a fan from its first corner would leave it. A line and a point are no triangles, nor is
 * what has no area. */
static void polygons(void **state)
{
    (void)state;
    static const float dart[][2] = {{0, 1}, {-2, -2}, {0, 0}, {2, -2}};
    static const unsigned faces[][5] = {{4, 0, 1, 2, 3}, {2, 0, 1}, {1, 2}, {3, 0, 0, 1}, {0}};
    struct writing file = begin(0, "element vertex 5\n" PLACES FACES(5));
    for (int i = 0; i < 4; i++)
        put_place(&file, dart[(i + 1) % 4][0], dart[(i + 1) % 4][1], 0);
    put_place(&file, 9, 9, 9);
    for (int i = 0; i < 5; i++)
        for (unsigned k = 0; k <= faces[i][0]; k++)
            put(&file, faces[i][k], k == 0 ? 1 : 4);
    struct imported imported = import_written(&file);
    expect_success(&imported);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_int_equal(mesh->triangle_count, 2);
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(imported.report.dropped_triangles, 1);
    double area = 0;
    for (size_t i = 0; i < 2; i++) {
        ps_vec3 a = mesh->vertices[mesh->triangles[i][0]];
        ps_vec3 b = mesh->vertices[mesh->triangles[i][1]];
        ps_vec3 c = mesh->vertices[mesh->triangles[i][2]];
        area += 0.5 * fabs((double)((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)));
    }
    expect_near(area, 2, 1e-6);
    release_imported(&imported);
}

/* More than are read at a time. */
static void many(void **state)
{
    (void)state;
    enum { COUNT = 150000 };
    size_t size = 300 + (COUNT + 2) * 12 + COUNT * 13, length;
    unsigned char *bytes = calloc(1, size);
    assert_non_null(bytes);
    length = (size_t)snprintf((char *)bytes, size,
                              "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" PLACES
                              "element face %d\nproperty list uchar uint vertex_indices\n"
                              "end_header\n",
                              COUNT + 2, COUNT);
    for (int i = 0; i < COUNT + 2; i++) {
        struct writing vertex = {.big_endian = 0};
        put_place(&vertex, (float)i, (float)(i % 2), 0);
        memcpy(bytes + length, vertex.bytes, vertex.length);
        length += vertex.length;
    }
    for (unsigned i = 0; i < COUNT; i++) {
        struct writing face = {.big_endian = 0};
        put(&face, 3, 1);
        for (unsigned k = 0; k < 3; k++)
            put(&face, i + k, 4);
        memcpy(bytes + length, face.bytes, face.length);
        length += face.length;
    }
    struct imported imported = import_bytes(bytes, length);
    free(bytes);
    expect_success(&imported);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_int_equal(mesh->vertex_count, COUNT + 2);
    assert_int_equal(mesh->triangle_count, COUNT);
    for (unsigned i = 0; i < COUNT; i++) {
        assert_int_equal(mesh->triangles[i][0], i);
        assert_int_equal(mesh->triangles[i][2], i + 2);
    }
    expect_vector(mesh->vertices[COUNT + 1], COUNT + 1, 1, 0);
    release_imported(&imported);
}

static void what_is_cut_is_refused(void **state)
{
    (void)state;
    struct writing file = begin(0, "element vertex 4\n" PLACES FACES(2));
    size_t data = file.length;
    put_square(&file);
    for (unsigned i = 0; i < 2; i++) {
        put(&file, 3, 1);
        put(&file, 0, 4);
        put(&file, 1 + i, 4);
        put(&file, 2 + i, 4);
    }
    struct imported imported = import_written(&file);
    expect_success(&imported);
    release_imported(&imported);
    for (size_t length = data; length < file.length; length++) {
        imported = import_bytes(file.bytes, length);
        expect_failure(&imported, PS_ERROR_INVALID,
                       length < data + 48 ? "m.ply: the file ends before its last vertex"
                                          : "m.ply: the file ends before its last face");
    }
    file.bytes[data + 49 + 8] = 4;
    imported = import_written(&file);
    expect_failure(&imported, PS_ERROR_INVALID, "m.ply: a face has a vertex that the file lacks");
    file.bytes[data + 49 + 8 + 3] = 0x80;
    imported = import_written(&file);
    expect_failure(&imported, PS_ERROR_INVALID, "m.ply: a face has a vertex that the file lacks");
}

static void a_header_without_end_is_refused(void **state)
{
    (void)state;
    struct writing file = begin(0, "element vertex 4\n" PLACES FACES(1));
    const char *end = strstr((const char *)file.bytes, "end_header");
    for (size_t length = 4; length <= (size_t)((const unsigned char *)end - file.bytes); length++) {
        struct imported imported = import_bytes(file.bytes, length);
        expect_failure(&imported, PS_ERROR_INVALID, "m.ply: the header has no end_header");
    }
}

static void impossible_counts_are_refused(void **state)
{
    (void)state;
    struct writing file = begin(0, "element vertex 4000000000\n" PLACES FACES(1));
    struct imported imported = import_written(&file);
    expect_failure(&imported, PS_ERROR_INVALID, "more than 200 million vertices or triangles");
    file = begin(0, "element vertex 4\n" PLACES FACES(4000000000));
    put_square(&file);
    imported = import_written(&file);
    expect_failure(&imported, PS_ERROR_INVALID, "the file ends before its last face");
    file = begin(0, "element vertex 4\n" PLACES FACES(0));
    put_square(&file);
    imported = import_written(&file);
    expect_failure(&imported, PS_ERROR_INVALID, "the file has no triangles");
}

/* What else a file may have is assimp's. */
static void other_elements(void **state)
{
    (void)state;
    struct writing file =
        begin(0, "element vertex 4\n" PLACES FACES(1) "element edge 1\nproperty int vertex1\n");
    put_square(&file);
    put(&file, 3, 1);
    for (unsigned i = 0; i < 3; i++)
        put(&file, i, 4);
    put(&file, 1, 4);
    struct imported imported = import_written(&file);
    expect_success(&imported);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 1);
    release_imported(&imported);
}

/* --- texts
 * ------------------------------------------------------------------------------------------- */

/* An element is a line, however it ends; what follows the numbers is nothing. */
static void a_text(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.ply", "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty double x\r\n"
                             "property float y\r\nproperty char z\r\nproperty uchar red\r\n"
                             "property uchar green\r\nproperty uchar blue\r\nproperty float nx\r\n"
                             "property float ny\r\nproperty float nz\r\nelement face 2\r\n"
                             "property uchar group\r\nproperty list uchar int vertex_indices\r\n"
                             "property float area\r\nend_header\r\n"
                             "0.25 -1e-1 300 255 0 0 0 0 1\r\n"
                             "  1.5\t.5   -2 300 -7 0 0 0 1   9 9\r\n"
                             "\r\n"
                             "+1 1 0 0 0 0 0 1 0\n"
                             "0 1 0 0 0 255 1 0 0\n"
                             "7 4 0 1 2 3 0.5\n"
                             "   \n"
                             "7 3 0 1 2 0.5");
    expect_success(&imported);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 3);
    expect_vector(mesh->vertices[0], 0.25, -0.1, 127); /* a char */
    expect_vector(mesh->vertices[1], 1.5, 0.5, -2);
    expect_vector(mesh->normals[3], 1, 0, 0);
    expect_near(mesh->colors[1][0], 1, 0);
    expect_near(mesh->colors[1][1], 0, 0);
    assert_int_equal(mesh->triangles[2][2], 2);
    release_imported(&imported);
}

#define TEXT_HEADER "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\n" PLACES FACES(1)

static void refused(const char *data, const char *words)
{
    char text[1024];
    snprintf(text, sizeof text, TEXT_HEADER "end_header\n%s", data);
    struct imported imported = import_text("m.ply", text);
    expect_failure(&imported, PS_ERROR_INVALID, words);
}

static void wrong_texts_are_refused(void **state)
{
    (void)state;
    refused("0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "m.ply:12: a number is missing");
    refused("0 0 0\n\n1 0 x\n0 1 0\n3 0 1 2\n", "m.ply:13: a number is missing");
    refused("0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "m.ply:14: a number is missing");
    refused("0 0 0\n1 0 0\n0 1 0\n-3 0 1\n", "m.ply:14: a number is missing");
    refused("0 0 0\n1 0 0\n0 1 0\n4000000000 0 1\n", "m.ply:14: a number is missing");
    refused("0 0 0\n1 0 0\n0 1 0\n", "m.ply: the file ends before its last face");
    refused("0 0 0\n1 0 0\n", "m.ply: the file ends before its last vertex");
    refused("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a face has a vertex that the file lacks");
    refused("", "m.ply: the file ends before its last vertex");
}

/* More than a piece: the mesh of the same numbers in a binary file. */
static void a_long_text(void **state)
{
    (void)state;
    enum { COUNT = 120000 };
    size_t size = 300 + (size_t)COUNT * 64, length;
    char *text = malloc(size);
    assert_non_null(text);
    length = (size_t)snprintf(text, size,
                              "ply\nformat ascii 1.0\nelement vertex %d\n" PLACES
                              "element face %d\nproperty list uchar uint vertex_indices\n"
                              "end_header\n",
                              COUNT + 2, COUNT);
    for (int i = 0; i < COUNT + 2; i++)
        length += (size_t)snprintf(text + length, size - length, "%d %d 0\n%s", i, i % 2,
                                   i % 1000 == 0 ? "\n" : "");
    for (int i = 0; i < COUNT; i++)
        length += (size_t)snprintf(text + length, size - length, "3 %d %d %d\n", i, i + 1, i + 2);
    assert_true(length > 3u << 20);
    struct imported imported = import_bytes((const unsigned char *)text, length);
    expect_success(&imported);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_int_equal(mesh->vertex_count, COUNT + 2);
    assert_int_equal(mesh->triangle_count, COUNT);
    for (unsigned i = 0; i < COUNT; i++) {
        expect_vector(mesh->vertices[i], i, i % 2, 0);
        assert_int_equal(mesh->triangles[i][0], i);
        assert_int_equal(mesh->triangles[i][2], i + 2);
    }
    release_imported(&imported);
    char *late = strrchr(text, '3');
    late[0] = 'x';
    imported = import_bytes((const unsigned char *)text, length);
    expect_failure(&imported, PS_ERROR_INVALID, ": a number is missing");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_all_types),
        cmocka_unit_test(normals_coordinates_and_colours),
        cmocka_unit_test(colours_of_other_types),
        cmocka_unit_test(polygons),
        cmocka_unit_test(many),
        cmocka_unit_test(what_is_cut_is_refused),
        cmocka_unit_test(a_header_without_end_is_refused),
        cmocka_unit_test(impossible_counts_are_refused),
        cmocka_unit_test(other_elements),
        cmocka_unit_test(a_text),
        cmocka_unit_test(wrong_texts_are_refused),
        cmocka_unit_test(a_long_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
