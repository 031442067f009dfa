/* test_mesh_hostile.c: files that are no good, and what is mended. */
#include "base/json_reader.h"
#include "mesh_fixture.h"
#include "scratch.h"
#include <sys/stat.h>

static struct imported import_path(const char *path)
{
    struct mesh_request request = request_all(path);
    return import_disk(&request);
}

static void write_bytes(const char *path, const void *bytes, size_t length)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, length, stream), length);
    fclose(stream);
}

/* --- files ------------------------------------------------------------------------------------ */

static void absent_file_is_named(void **state)
{
    struct imported imported = import_path(scratch_path(state, "none.obj"));
    expect_failure(&imported, PS_ERROR_IO, "none.obj: cannot open: No such file");
}

static void folders_and_pipes_are_refused(void **state)
{
    const char *folder = scratch_path(state, "folder.obj"), *pipe = scratch_path(state, "pipe.obj");
    assert_int_equal(mkdir(folder, 0700), 0);
    struct imported imported = import_path(folder);
    expect_failure(&imported, PS_ERROR_IO, "directory");
    assert_int_equal(rmdir(folder), 0);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    alarm(600); /* it must not wait for a writer */
    imported = import_path(pipe);
    alarm(0);
    expect_failure(&imported, PS_ERROR_IO, "not a regular file");
}

static void enormous_file_is_refused_unread(void **state)
{
    const char *path = scratch_path(state, "large.stl");
    write_bytes(path, "solid", 5);
    if (truncate(path, (off_t)5 << 30) != 0)
        skip(); /* no sparse files here */
    struct imported imported = import_path(path);
    expect_failure(&imported, PS_ERROR_INVALID, "larger than 4 GiB");
}

static void unknown_extension_lists_the_known(void **state)
{
    (void)state;
    static const char *const names[] = {"m.blend", "m.off", "m", "m.", "obj", "d.obj/m", "m.obj~"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct imported imported = import_text(names[i], "v 0 0 0\n");
        expect_failure(&imported, PS_ERROR_INVALID, ".obj, .gltf, .glb, .ply, .stl");
    }
}

static void empty_and_random_files_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"m.obj", "m.gltf", "m.glb", "m.ply",
                                        "m.stl", "m.dae",  "m.fbx", "m.3ds"};
    char rubbish[4096];
    uint32_t random = 1;
    for (size_t i = 0; i < sizeof rubbish; i++)
        rubbish[i] = (char)((random = random * 1664525u + 1013904223u) >> 24);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct mesh_request request = request_all(names[i]);
        struct mesh_memory_file file = {names[i], rubbish, 0};
        struct imported imported = import_files(&request, &file, 1);
        expect_failure(&imported, PS_ERROR_INVALID, "empty");
        file.length = sizeof rubbish;
        imported = import_files(&request, &file, 1);
        expect_failure(&imported, PS_ERROR_INVALID, names[i]);
    }
}

/* Cut anywhere, a .glb fails with a message; never crashes. */
static void truncated_glb_is_refused(void **state)
{
    (void)state;
    static unsigned char bytes[65536];
    FILE *stream = fopen(data_path("blender.glb"), "rb");
    assert_non_null(stream);
    size_t length = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    struct mesh_request request = request_all("m.glb");
    for (size_t cut = 1; cut < length; cut += cut < 64 ? 1 : 97) {
        struct mesh_memory_file file = {"m.glb", bytes, cut};
        struct imported imported = import_files(&request, &file, 1);
        expect_failure(&imported, PS_ERROR_INVALID, "m.glb");
    }
    struct mesh_memory_file file = {"m.glb", bytes, length};
    struct imported imported = import_files(&request, &file, 1);
    expect_success(&imported);
    release_imported(&imported);
}

/* --- geometry --------------------------------------------------------------------------------- */

static void indices_out_of_range_are_refused(void **state)
{
    (void)state;
    struct imported imported = import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    expect_failure(&imported, PS_ERROR_INVALID, "m.obj");
    imported = import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -9\n");
    expect_failure(&imported, PS_ERROR_INVALID, "m.obj");
    for (int corners = 3; corners <= 4; corners++) {
        char text[512];
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                 "end_header\n0 0 0\n1 0 0\n0 1 0\n%d 0 1 2000000000 2\n",
                 corners);
        imported = import_text("m.ply", text);
        expect_failure(&imported, PS_ERROR_INVALID, "a face has a vertex that the file lacks");
    }
}

static void bad_triangles_are_dropped_and_counted(void **state)
{
    (void)state;
    struct imported imported = import_text(
        "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv inf 1 1\nv 2 0 0\nv 0.5 1e-12 0\n"
                 "f 1 2 3\nf 1 2 4\nf 1 3 5\nf 1 2 6\nf 1 1 2\nf 1 2 7\nf 3 2 1\n");
    expect_success(&imported);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 2);
    assert_int_equal(mesh_of(&imported, 0)->vertex_count, 3);
    assert_int_equal(imported.report.dropped_triangles, 5);
    for (size_t i = 0; i < mesh_of(&imported, 0)->vertex_count; i++)
        assert_true(isfinite(mesh_of(&imported, 0)->vertices[i].x));
    release_imported(&imported);
}

static void tiny_triangles_are_kept(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", "v 0 0 0\nv 1e-7 0 0\nv 0 1e-7 0\nv 1e6 0 0\nv 1e6 1 0\n"
                             "f 1 2 3\nf 1 4 5\n");
    expect_success(&imported);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 2);
    assert_int_equal(imported.report.dropped_triangles, 0);
    release_imported(&imported);
}

/* A normal computed in floats would be NaN. */
static void triangles_beyond_floats_are_dropped(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", "v 0 0 0\nv 1e-20 0 0\nv 0 1e-20 0\nv 1e30 0 0\nv 0 1e30 0\n"
                             "v 1 0 0\nv 0 1 0\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1//1 4//1 5//1\n"
                             "f 1//1 6//1 7//1\n");
    expect_success(&imported);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 1);
    assert_int_equal(imported.report.dropped_triangles, 2);
    expect_vector(mesh_of(&imported, 0)->normals[0], 0, 0, 1);
    release_imported(&imported);
}

/* Three triangles at one edge, and one alone. */
static void non_manifold_geometry_is_accepted(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 9 9 9\nv 9 8 7\n"
                             "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 6 7\n");
    expect_success(&imported);
    assert_int_equal(mesh_of(&imported, 0)->triangle_count, 4);
    release_imported(&imported);
}

static void file_without_triangles_is_refused(void **state)
{
    (void)state;
    struct imported imported = import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    expect_failure(&imported, PS_ERROR_INVALID, "no triangles");
    imported = import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\np 3\n");
    expect_failure(&imported, PS_ERROR_INVALID, "no triangles");
    imported = import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expect_failure(&imported, PS_ERROR_INVALID, "no triangles");
}

/* --- what makes assimp 5.2 crash, wait for ever, or use up the stack or the memory
 * ------------------ */

/* The error may be assimp's own, or that it crashed or took too long: that is its version's
 * business. */
static void expect_refused(const char *path, const char *text)
{
    struct mesh_request request = request_all(path);
    request.seconds = 1;
    const struct mesh_memory_file file = text_file(path, text);
    struct imported imported = import_files(&request, &file, 1);
    expect_failure(&imported, PS_ERROR_INVALID, path);
}

static void impossible_ply_headers_are_refused(void **state)
{
    (void)state;
    static const char *const elements[] = {
        "element vertex 4000000000\n",
        "element vertex 99999999999999999999\n",
        "element vertex -1\n",
        "element vertex 1\nproperty float x\nelement vertex 9\n",
        "element face 1\nelement tristrips 9\n",
        "element vertex 1\nproperty flot x\n",
        "element vertex 1\npzroperty float x\n",
        "element vertex 1\nproperty float x\nend_header\v\n",
    };
    for (size_t i = 0; i < sizeof elements / sizeof elements[0]; i++) {
        char text[512];
        snprintf(text, sizeof text, "ply\nformat ascii 1.0\n%sproperty float x\nend_header\n0\n",
                 elements[i]);
        expect_refused("m.ply", text);
    }
    expect_refused("m.ply", "ply\nformat ascii 1.0\nelement vertex 1\n");
}

static void an_obj_is_not_its_own_library(void **state)
{
    (void)state;
    expect_refused("m.obj", "mtllib m.obj\nv 0 0 0\nv 1 0 0\nv 0 1 0\nmap_Kd a.png\nusemtl m\n");
}

#define TOO_DEEP 2000000

static void expect_deep_is_refused(const char *path, const char *start, const char *again)
{
    size_t first = strlen(start), each = strlen(again);
    char *text = malloc(first + TOO_DEEP * each + 1);
    assert_non_null(text);
    snprintf(text, first + 1, "%s", start);
    for (size_t i = 0; i < TOO_DEEP; i++)
        memcpy(text + first + i * each, again, each + 1);
    expect_refused(path, text);
    free(text);
}

static void deep_files_are_refused(void **state)
{
    (void)state;
    expect_deep_is_refused("m.dae", "<?xml version=\"1.0\"?><COLLADA>", "<node>");
    expect_deep_is_refused("m.fbx", "; FBX 7.1.0 project file\n", "A: {");
    expect_deep_is_refused("m.gltf", "", "[");
}

static void announced_numbers_are_not_believed(void **state)
{
    (void)state;
    expect_refused("m.dae", "<COLLADA><float_array count=\"150994944\">1</float_array></COLLADA>");
    expect_refused("m.fbx", "; FBX 7.1.0 project file\nVertices: *4000000000 {\n a: 1\n}\n");
}

/* --- JSON ------------------------------------------------------------------------------------- */

static ps_result read_json(const char *text, struct json **root, struct arena *arena)
{
    static char copy[100000];
    struct error error;
    snprintf(copy, sizeof copy, "%s", text);
    return json_read(arena, copy, strlen(copy), root, &error);
}

static void json_is_read(void **state)
{
    (void)state;
    struct arena arena = {0};
    struct json *root;
    size_t size;
    assert_int_equal(
        read_json(" {\"a\\\"b\": [1, -2.5e1, true, null, \"x\"], \"n\": 12}\n", &root, &arena),
        PS_OK);
    const struct json *list = json_member(root, "a\\\"b");
    assert_non_null(list);
    assert_int_equal(list->count, 5);
    expect_near(json_element(list, 1)->number, -25, 0);
    assert_int_equal(json_element(list, 2)->kind, JSON_BOOLEAN);
    assert_int_equal(json_element(list, 3)->kind, JSON_NULL);
    assert_true(json_is(&json_element(list, 4)->text, "x"));
    assert_null(json_element(list, 5));
    assert_null(json_member(list, "n"));
    assert_true(json_size(root, "n", 0, &size) && size == 12);
    assert_true(json_size(root, "m", 7, &size) && size == 7);
    arena_release(&arena);
}

static void broken_json_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",    "{",  "[1,]", "{\"a\"}", "{a:1}",    "\"x",      "\"x\\", "[1 2]",    "{} {}",
        "nul", "1.", "-",    "[1}",     "{\"a\":}", "\"\001\"", "1e999", "[00,\"a]", "{\"a\":1,}"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct arena arena = {0};
        struct json *root;
        if (read_json(texts[i], &root, &arena) != PS_ERROR_INVALID)
            fail_msg("accepted: %s", texts[i]);
        arena_release(&arena);
    }
    static char deep[100000];
    memset(deep, '[', sizeof deep - 1);
    struct arena arena = {0};
    struct json *root;
    assert_int_equal(read_json(deep, &root, &arena), PS_ERROR_INVALID);
    arena_release(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(absent_file_is_named),
        SCRATCH_TEST(folders_and_pipes_are_refused),
        SCRATCH_TEST(enormous_file_is_refused_unread),
        cmocka_unit_test(unknown_extension_lists_the_known),
        cmocka_unit_test(empty_and_random_files_are_refused),
        cmocka_unit_test(truncated_glb_is_refused),
        cmocka_unit_test(indices_out_of_range_are_refused),
        cmocka_unit_test(bad_triangles_are_dropped_and_counted),
        cmocka_unit_test(tiny_triangles_are_kept),
        cmocka_unit_test(triangles_beyond_floats_are_dropped),
        cmocka_unit_test(non_manifold_geometry_is_accepted),
        cmocka_unit_test(file_without_triangles_is_refused),
        cmocka_unit_test(impossible_ply_headers_are_refused),
        cmocka_unit_test(an_obj_is_not_its_own_library),
        cmocka_unit_test(deep_files_are_refused),
        cmocka_unit_test(announced_numbers_are_not_believed),
        cmocka_unit_test(json_is_read),
        cmocka_unit_test(broken_json_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
