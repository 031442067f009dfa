/* test_mesh_colors.c: colours of vertices in OBJ, PLY and glTF, and what materials do with them. */
#include "mesh_fixture.h"

#define HALF_LINEAR 0.2140411 /* of 1/2 in sRGB */

static const char obj[] = "v 0 0 0 1 0 0.5\nv 1 0 0 1 0 0.5\nv 0 1 0 0 1 0.5\n";

static struct imported import_obj(const char *before, const char *after, const char *mtl)
{
    char text[512];
    struct mesh_request request = request_all("d/m.obj");
    snprintf(text, sizeof text, "%s%s%sf 1 2 3\n", before, obj, after);
    const struct mesh_memory_file files[] = {text_file("d/m.obj", text),
                                             text_file("d/m.mtl", mtl ? mtl : "")};
    struct imported imported = import_files(&request, files, mtl ? 2 : 1);
    expect_success(&imported);
    return imported;
}

static void expect_rgba(const float rgba[4], double r, double g, double b, double a)
{
    expect_color((ps_rgb){rgba[0], rgba[1], rgba[2]}, r, g, b);
    expect_near(rgba[3], a, 1e-6);
}

/* --- OBJ and PLY
 * -------------------------------------------------------------------------------- */

static void obj_colours_are_srgb_and_make_a_material(void **state)
{
    (void)state;
    struct imported imported = import_obj("", "", NULL);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_non_null(mesh->colors);
    expect_rgba(mesh->colors[mesh->triangles[0][0]], 1, 0, HALF_LINEAR, 1);
    expect_rgba(mesh->colors[mesh->triangles[0][2]], 0, 1, HALF_LINEAR, 1);
    const struct material_description *m = material_named(&imported, "vertex colors");
    assert_ptr_equal(m, &imported.fragment.materials[imported.fragment.objects[0].material]);
    assert_int_equal(m->kind, MATERIAL_DIFFUSE);
    assert_true(m->color.vertex_colors);
    expect_color(m->color.colors[0], 1, 1, 1);
    release_imported(&imported);
}

static void colours_multiply_the_material(void **state)
{
    (void)state;
    struct imported imported =
        import_obj("mtllib m.mtl\n", "usemtl m\n", "newmtl m\nKd 0.5 0.4 0.3\n");
    assert_int_equal(imported.fragment.material_count, 1);
    const struct material_description *m = material_named(&imported, "m");
    assert_true(m->color.vertex_colors);
    expect_color(m->color.colors[0], 0.5, 0.4, 0.3);
    release_imported(&imported);
    /* A mirror over a diffuse part: the latter alone. */
    imported = import_obj("mtllib m.mtl\n", "usemtl m\n",
                          "newmtl m\nKd 0.5 0.4 0.3\nKs 0.2 0.2 0.2\nillum 3\n");
    assert_false(material_named(&imported, "m:mirror")->color.vertex_colors);
    assert_true(material_named(&imported, "m:diffuse")->color.vertex_colors);
    release_imported(&imported);
}

static void absent_material_becomes_one_of_colours(void **state)
{
    (void)state;
    struct imported imported = import_obj("mtllib m.mtl\n", "usemtl m\n", NULL);
    const struct material_description *m = material_named(&imported, "m");
    assert_false(material_is_absent(m));
    assert_true(m->color.vertex_colors);
    release_imported(&imported);
}

static void colours_go_with_the_materials(void **state)
{
    (void)state;
    struct mesh_request request = request_all("m.obj");
    char text[512];
    request.materials = false;
    snprintf(text, sizeof text, "%sf 1 2 3\n", obj);
    const struct mesh_memory_file file = text_file("m.obj", text);
    struct imported imported = import_files(&request, &file, 1);
    expect_success(&imported);
    assert_null(mesh_of(&imported, 0)->colors);
    assert_true(imported.fragment.objects[0].material == NO_INDEX);
    release_imported(&imported);
}

static struct imported import_ply(const char *properties, const char *vertices)
{
    char text[1024];
    snprintf(text, sizeof text,
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
             "property float z\n%selement face 1\nproperty list uchar int vertex_indices\n"
             "end_header\n%s3 0 1 2\n",
             properties, vertices);
    struct imported imported = import_text("m.ply", text);
    expect_success(&imported);
    return imported;
}

#define PLY_COLORS "property uchar red\nproperty uchar green\nproperty uchar blue\n"

static void ply_colours_are_srgb(void **state)
{
    (void)state;
    struct imported imported =
        import_ply(PLY_COLORS, "0 0 0 255 0 188\n1 0 0 0 0 0\n0 1 0 0 255 0\n");
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    expect_rgba(mesh->colors[mesh->triangles[0][0]], 1, 0, 0.5028865, 1);
    expect_rgba(mesh->colors[mesh->triangles[0][1]], 0, 0, 0, 1);
    assert_true(material_named(&imported, "vertex colors")->color.vertex_colors);
    release_imported(&imported);
}

/* They take memory, and change nothing. */
static void white_is_no_colour(void **state)
{
    (void)state;
    struct imported imported =
        import_ply(PLY_COLORS, "0 0 0 255 255 255\n1 0 0 255 255 255\n0 1 0 255 255 255\n");
    assert_null(mesh_of(&imported, 0)->colors);
    assert_int_equal(imported.fragment.material_count, 0);
    release_imported(&imported);
}

/* assimp keeps the colours apart from the vertices: which belongs to which is lost. */
static void colours_of_some_vertices_are_left_out(void **state)
{
    (void)state;
    const char *const texts[] = {"v 0 0 1\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 2 3 4\n",
                                 "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n"};
    for (size_t i = 0; i < 2; i++) {
        struct imported imported = import_text("m.obj", texts[i]);
        expect_success(&imported);
        assert_null(mesh_of(&imported, 0)->colors);
        assert_string_equal(imported.report.notes,
                            "some vertices have colours and others none: the colours are left out");
        release_imported(&imported);
    }
}

static void colours_out_of_range_are_told_once(void **state)
{
    (void)state;
    const char *const texts[] = {"v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 255 0\nf 1 2 3\n",
                                 "v 0 0 0 nan 0 0\nv 1 0 0 0 0 0\nv 0 1 0 -1 0 0\nf 1 2 3\n"};
    for (size_t i = 0; i < 2; i++) {
        struct imported imported = import_text("m.obj", texts[i]);
        expect_success(&imported);
        const struct mesh_description *mesh = mesh_of(&imported, 0);
        expect_rgba(mesh->colors[mesh->triangles[0][0]], i == 0, 0, 0, 1);
        assert_string_equal(imported.report.notes,
                            "what is below 0 or above 1 in vertex colours is left out");
        release_imported(&imported);
    }
}

static void alpha_of_ply_is_told(void **state)
{
    (void)state;
    struct imported imported =
        import_ply(PLY_COLORS "property uchar alpha\n",
                   "0 0 0 255 0 188 255\n1 0 0 0 0 0 255\n0 1 0 0 255 0 255\n");
    assert_string_equal(imported.report.notes, "");
    release_imported(&imported);
    imported = import_ply(PLY_COLORS "property uchar alpha\n",
                          "0 0 0 255 0 188 255\n1 0 0 0 0 0 9\n0 1 0 0 255 0 255\n");
    expect_near(mesh_of(&imported, 0)->colors[1][3], 1, 0);
    assert_string_equal(imported.report.notes, "the alpha of vertex colours is left out");
    release_imported(&imported);
}

/* --- glTF
 * ------------------------------------------------------------------------------------------ */

/* A triangle, colours with alpha as floats, and two sets of coordinates; the same triangle without
 * colours. */
static const float content[] = {0,     0,    0,    1, 0,    0, 0, 1,     0, 0.5f, 2, -1, 0.25f,
                                0.5f,  0.5f, 0.5f, 1, 0.5f, 0, 1, 0.75f, 0, 0,    1, 0,  0,
                                0.25f, 1,    1,    1, 0,    1, 1, 1,     0, 1,    1, 1,  0};

static struct imported import_gltf(const char *material, const char *attributes)
{
    char text[4096];
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
        "\"nodes\":[{\"mesh\":0},{\"mesh\":1}],\"meshes\":[{\"primitives\":[{\"attributes\":"
        "{\"POSITION\":0,\"TEXCOORD_0\":2%s},\"material\":0}]},{\"primitives\":[{"
        "\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"material\":1}]}],"
        "\"materials\":[{\"name\":\"m\"%s},{\"name\":\"plain\"%s}],"
        "\"buffers\":[{\"byteLength\":156,\"uri\":\"m.bin\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
        "\"byteLength\":48},{\"buffer\":0,\"byteOffset\":84,\"byteLength\":24},"
        "{\"buffer\":0,\"byteOffset\":108,\"byteLength\":48}],"
        "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"a.png\"}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":3,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":2,\"type\":\"VEC4\"}]}",
        attributes, material, material);
    struct mesh_request request = request_all("d/m.gltf");
    const struct mesh_memory_file files[] = {text_file("d/m.gltf", text),
                                             {"d/m.bin", content, sizeof content},
                                             text_file("d/a.png", PNG_START)};
    struct imported imported = import_files(&request, files, 3);
    expect_success(&imported);
    return imported;
}

#define COLORED ",\"COLOR_0\":1"

static void gltf_colours_are_linear_and_within_range(void **state)
{
    (void)state;
    struct imported imported = import_gltf("", COLORED);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    expect_rgba(mesh->colors[mesh->triangles[0][0]], 0.5, 1, 0, 0.25);
    expect_rgba(mesh->colors[mesh->triangles[0][2]], 0.5, 0, 1, 0.75);
    assert_null(mesh_of(&imported, 1)->colors);
    assert_string_equal(imported.report.notes,
                        "what is below 0 or above 1 in vertex colours is left out");
    release_imported(&imported);
    imported = import_gltf("", ",\"COLOR_0\":3"); /* three numbers each: no alpha */
    mesh = mesh_of(&imported, 0);
    expect_rgba(mesh->colors[mesh->triangles[0][0]], 0.5, 1, 0, 1);
    release_imported(&imported);
}

static void alpha_of_colours_counts_where_that_of_the_material_does(void **state)
{
    (void)state;
    struct imported imported = import_gltf(",\"alphaMode\":\"BLEND\"", COLORED);
    assert_true(material_named(&imported, "m")->blended);
    assert_true(material_named(&imported, "m")->opacity.vertex_colors);
    assert_true(material_named(&imported, "m")->color.vertex_colors);
    assert_false(material_named(&imported, "plain")->opacity.vertex_colors);
    assert_false(material_named(&imported, "plain")->color.vertex_colors);
    release_imported(&imported);
    imported = import_gltf("", COLORED);
    assert_false(material_named(&imported, "m")->opacity.vertex_colors);
    release_imported(&imported);
}

static void alpha_of_0_is_one(void **state)
{
    (void)state;
    struct imported imported =
        import_gltf(",\"alphaMode\":\"BLEND\"", ",\"COLOR_0\":4"); /* white */
    expect_rgba(mesh_of(&imported, 0)->colors[0], 1, 1, 1, 0);
    assert_true(material_named(&imported, "m")->opacity.vertex_colors);
    release_imported(&imported);
}

static void colours_of_another_count_are_told(void **state)
{
    (void)state;
    struct imported imported = import_gltf("", ",\"COLOR_0\":5");
    assert_null(mesh_of(&imported, 0)->colors);
    assert_string_equal(imported.report.notes,
                        "vertex colours that are not as many as the vertices are left out");
    release_imported(&imported);
}

#define SECOND_SET ",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":1}}"

static void second_set_is_kept_where_it_is_used(void **state)
{
    (void)state;
    struct imported imported = import_gltf(SECOND_SET, ",\"TEXCOORD_1\":2");
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_int_equal(material_named(&imported, "m")->color.uv_set, 1);
    assert_non_null(mesh->second_uv);
    expect_near(mesh->second_uv[mesh->triangles[0][2]][1], 0.75, 1e-6); /* upwards */
    assert_string_equal(imported.report.notes, "");
    release_imported(&imported);
    imported = import_gltf("", ",\"TEXCOORD_1\":2");
    assert_null(mesh_of(&imported, 0)->second_uv);
    release_imported(&imported);
}

static void beside_colours_the_second_set_is_left_out(void **state)
{
    (void)state;
    struct imported imported = import_gltf(SECOND_SET, ",\"TEXCOORD_1\":2" COLORED);
    assert_int_equal(material_named(&imported, "m")->color.uv_set, 0);
    assert_int_equal(material_named(&imported, "plain")->color.uv_set, 1);
    assert_non_null(strstr(imported.report.notes,
                           "beside vertex colours, the second set of texture coordinates of "
                           "material m is left out"));
    release_imported(&imported);
    imported = import_gltf(",\"pbrMetallicRoughness\":{\"metallicFactor\":0.5,"
                           "\"baseColorTexture\":{\"index\":0,\"texCoord\":1}}",
                           ",\"TEXCOORD_1\":2" COLORED);
    assert_int_equal(material_named(&imported, "m:metal")->color.uv_set, 0);
    assert_null(strstr(imported.report.notes, "more"));
    release_imported(&imported);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obj_colours_are_srgb_and_make_a_material),
        cmocka_unit_test(colours_multiply_the_material),
        cmocka_unit_test(absent_material_becomes_one_of_colours),
        cmocka_unit_test(colours_go_with_the_materials),
        cmocka_unit_test(ply_colours_are_srgb),
        cmocka_unit_test(white_is_no_colour),
        cmocka_unit_test(colours_of_some_vertices_are_left_out),
        cmocka_unit_test(colours_out_of_range_are_told_once),
        cmocka_unit_test(alpha_of_ply_is_told),
        cmocka_unit_test(gltf_colours_are_linear_and_within_range),
        cmocka_unit_test(alpha_of_colours_counts_where_that_of_the_material_does),
        cmocka_unit_test(alpha_of_0_is_one),
        cmocka_unit_test(colours_of_another_count_are_told),
        cmocka_unit_test(second_set_is_kept_where_it_is_used),
        cmocka_unit_test(beside_colours_the_second_set_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
