/* test_mesh_mtl.c: what MTL's statements become. */
#include "image/raster.h"
#include "mesh_fixture.h"
#include "scratch.h"

static const char triangle[] = "mtllib m.mtl\n"
                               "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
                               "vt 0 0\nvt 1 0\nvt 0 0.75\n"
                               "usemtl m\nf 1/1 2/2 3/3\n";

static struct imported import_mtl_of(const struct mesh_request *request, const char *mtl)
{
    char text[8192];
    snprintf(text, sizeof text, "newmtl m\n%s\n", mtl);
    const struct mesh_memory_file files[] = {text_file("d/m.obj", triangle),
                                             text_file("d/m.mtl", text),
                                             text_file("d/a.png", PNG_START),
                                             text_file("d/sub/b c.png", PNG_START),
                                             text_file("d/a.ktx2", "\xabKTX 20\xbb\r\n\x1a\n...."),
                                             text_file("d/b.webp", "RIFF")};
    struct imported imported = import_files(request, files, 6);
    expect_success(&imported);
    return imported;
}

static struct imported import_mtl(const char *mtl)
{
    struct mesh_request request = request_all("d/m.obj");
    return import_mtl_of(&request, mtl);
}

static void kd_is_diffuse(void **state)
{
    (void)state;
    struct imported imported = import_mtl("  Kd 0.1 0.2 0.3\n\tKs 0.5 0.5 0.5\nNs 10\nillum 1");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_DIFFUSE);
    expect_color(m->color.colors[0], 0.1, 0.2, 0.3);
    expect_color(m->opacity.colors[0], 1, 1, 1);
    expect_color(m->emission.colors[0], 0, 0, 0);
    assert_int_equal(imported.fragment.objects[0].material, 0);
    assert_true(m->normal_map.texture == NO_INDEX);
    release_imported(&imported);
}

/* Once for each material, whatever of it is above 1; and only where it counts. */
static void reflectances_above_1_are_told(void **state)
{
    (void)state;
    struct imported imported =
        import_mtl("Kd 2 0.4 1\nKs 3 1 1\nillum 2\nnewmtl n\nKd 2 0 0\nKs 3 1 1\nillum 1");
    expect_color(material_named(&imported, "m")->color.colors[0], 1, 0.4, 1);
    assert_string_equal(imported.report.notes,
                        "what is above 1 in the reflectance of material m and 1 more is left out");
    release_imported(&imported);
}

static void ke_is_radiance(void **state)
{
    (void)state;
    struct imported imported = import_mtl("Kd 0.78 0.78 0.78\nKe 17 12 4\nillum 2");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_DIFFUSE);
    expect_color(m->emission.colors[0], 17, 12, 4);
    assert_false(m->emission_both);
    release_imported(&imported);
}

static void ks_with_illum_2_is_a_coat(void **state)
{
    (void)state;
    struct imported imported = import_mtl("Kd 0.5 0.4 0.3\nKs 0.9 0.8 0.7\nNs 40\nillum 2");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_GLOSSY);
    expect_color(m->color.colors[0], 0.5, 0.4, 0.3);
    expect_color(m->specular.colors[0], 0.9, 0.8, 0.7);
    expect_near(pow(m->roughness.colors[0].r, 2), sqrt(2.0 / 42), 1e-6); /* GGX alpha */
    release_imported(&imported);
    struct mesh_request request = request_all("d/m.obj");
    request.diffuse_only = true;
    imported = import_mtl_of(&request, "Kd 0.5 0.4 0.3\nKs 0.9 0.8 0.7\nNs 40\nillum 2");
    assert_int_equal(material_named(&imported, "m")->kind, MATERIAL_DIFFUSE);
    release_imported(&imported);
}

static void colors_may_be_srgb(void **state)
{
    (void)state;
    struct mesh_request request = request_all("d/m.obj");
    request.srgb_colors = true;
    struct imported imported = import_mtl_of(&request, "Kd 0.5 0.02 1\nKs 0.5 0.5 0.5\nNs 40\n"
                                                       "Ke 3 0.5 0\nillum 2");
    const struct material_description *m = material_named(&imported, "m");
    expect_color(m->color.colors[0], 0.2140411, 0.02 / 12.92, 1);
    expect_color(m->specular.colors[0], 0.2140411, 0.2140411, 0.2140411);
    expect_color(m->emission.colors[0], 3, 0.5, 0);
    release_imported(&imported);
}

static void bumps_are_scaled(void **state)
{
    (void)state;
    struct mesh_request request = request_all("d/m.obj");
    request.bump_scale = 0.25;
    struct imported imported = import_mtl_of(&request, "bump -bm 2 a.png");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->bump.kind, PIGMENT_IMAGE);
    expect_color(m->bump.colors[0], 0.5, 0.5, 0.5);
    release_imported(&imported);
    request.bump_scale = 0;
    imported = import_mtl_of(&request, "bump -bm 2 a.png");
    assert_int_equal(material_named(&imported, "m")->bump.kind, PIGMENT_COLOR);
    assert_int_equal(imported.fragment.texture_count, 0);
    release_imported(&imported);
}

static void almost_black_kd_under_a_mirror_is_black(void **state)
{
    (void)state;
    struct imported imported = import_mtl("Kd 0.01 0.01 0.01\nKs 0.95 0.9 0.85\nNs 1000\nillum 5");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(imported.fragment.material_count, 1);
    assert_int_equal(m->kind, MATERIAL_MIRROR);
    expect_color(m->color.colors[0], 0.95, 0.9, 0.85);
    release_imported(&imported);
}

/* What the parts reflect, by their weights, is Ks and Kd again. */
static void mirror_over_kd_is_a_mix(void **state)
{
    (void)state;
    struct imported imported = import_mtl("Kd 0.1 0.3 0.2\nKs 0.5 0.25 0.5\nillum 3");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_MIX);
    assert_int_equal(m->component_count, 2);
    const struct material_description *mirror = &imported.fragment.materials[m->components[0]];
    const struct material_description *diffuse = &imported.fragment.materials[m->components[1]];
    assert_int_equal(mirror->kind, MATERIAL_MIRROR);
    assert_int_equal(diffuse->kind, MATERIAL_DIFFUSE);
    assert_string_equal(mirror->name, "m:mirror");
    assert_true(imported.fragment.objects[0].material == (size_t)(m - imported.fragment.materials));
    expect_color(ps_rgb_scale(mirror->color.colors[0], (float)m->weights[0]), 0.5, 0.25, 0.5);
    expect_color(ps_rgb_scale(diffuse->color.colors[0], (float)m->weights[1]), 0.1, 0.3, 0.2);
    release_imported(&imported);
    imported = import_mtl("Kd 0.9 0.9 0.9\nKs 0.9 0.9 0.9\nillum 3"); /* more than there is */
    m = material_named(&imported, "m");
    expect_near(m->weights[0], 0.5, 1e-6);
    expect_near(m->weights[1], 0.5, 1e-6);
    release_imported(&imported);
}

static void refracting_illum_is_glass(void **state)
{
    (void)state;
    struct imported imported = import_mtl(
        "Kd 0.01 0.01 0.01\nKs 0.3 0.3 0.3\nTf 0.25 0.49 1\nNs 200\nNi 2.5\nd 0\nillum 7");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_DIELECTRIC);
    expect_near(m->ior, 2.5, 1e-6);
    expect_color(m->color.colors[0], 0.5, 0.7, 1); /* twice makes Tf */
    expect_color(m->opacity.colors[0], 1, 1, 1);   /* glass is there */
    release_imported(&imported);
    /* Exporters write these beside opaque paint. */
    imported = import_mtl("Kd 0.5 0.5 0.5\nTf 1 1 1\nNi 1.5\nd 1\nillum 2");
    assert_int_equal(material_named(&imported, "m")->kind, MATERIAL_DIFFUSE);
    release_imported(&imported);
    imported = import_mtl("Kd 0.5 0.5 0.5\nTf 0.81 0.81 0.81\nNi 1.5\n"); /* no illum */
    assert_int_equal(material_named(&imported, "m")->kind, MATERIAL_DIELECTRIC);
    release_imported(&imported);
}

static void d_and_tr_are_opacity(void **state)
{
    (void)state;
    struct imported imported = import_mtl("Kd 0.5 0.5 0.5\nd 0.3\nillum 1");
    expect_near(material_named(&imported, "m")->opacity.colors[0].r, 0.3, 1e-6);
    assert_true(material_named(&imported, "m")->blended);
    release_imported(&imported);
    imported = import_mtl("Kd 0.5 0.5 0.5\nTr 0.3\nillum 1");
    expect_near(material_named(&imported, "m")->opacity.colors[0].r, 0.7, 1e-6);
    release_imported(&imported);
}

static void maps_are_textures(void **state)
{
    (void)state;
    struct imported imported = import_mtl(
        "Kd 0.5 0.6 0.7\nKe 0 0 0\nmap_Kd -clamp on a.png\nmap_Ke a.png\nmap_d sub\\b c.png\n"
        "map_bump -bm 0.2 a.png\nnorm sub/b c.png\nillum 1");
    const struct material_description *m = material_named(&imported, "m");
    const struct texture_description *textures = imported.fragment.textures;
    assert_int_equal(m->color.kind, PIGMENT_IMAGE);
    expect_color(m->color.colors[0], 0.5, 0.6, 0.7);
    assert_string_equal(textures[m->color.texture].path, "d/a.png");
    assert_int_equal(textures[m->color.texture].wrap_u, WRAP_CLAMP);
    assert_int_equal(textures[m->color.texture].encoding, ENCODING_AUTO);
    expect_color(m->emission.colors[0], 1, 1, 1); /* a picture beside black */
    assert_int_equal(textures[m->emission.texture].wrap_u, WRAP_REPEAT);
    assert_string_equal(textures[m->opacity.texture].path, "d/sub/b c.png");
    assert_int_equal(m->opacity.channel, CHANNEL_RGB);
    assert_int_equal(textures[m->opacity.texture].encoding, ENCODING_LINEAR);
    expect_near(m->bump.colors[0].r, 0.2, 1e-6);
    assert_int_equal(m->normal_map.texture,
                     m->opacity.texture); /* one file, read one way: one texture */
    assert_int_equal(imported.fragment.texture_count, 4);
    assert_int_equal(imported.report.missing_textures, 0);
    release_imported(&imported);
}

static void picture_of_colour_and_opacity_gives_its_alpha(void **state)
{
    (void)state;
    struct imported imported = import_mtl("Kd 1 1 1\nmap_Kd a.png\nmap_d a.png\nillum 1");
    assert_int_equal(material_named(&imported, "m")->opacity.channel, CHANNEL_A);
    release_imported(&imported);
}

static void bump_grows_with_the_unit(void **state)
{
    (void)state;
    struct mesh_request request = request_all("d/m.obj");
    request.unit = 10;
    struct imported imported = import_mtl_of(&request, "Kd 1 1 1\nbump a.png\nillum 1");
    expect_near(material_named(&imported, "m")->bump.colors[0].r, 10, 1e-5);
    release_imported(&imported);
}

static void missing_texture_is_reported(void **state)
{
    (void)state;
    struct imported imported = import_mtl("Kd 0.5 0.6 0.7\nmap_Kd nowhere.png\nillum 1");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->color.kind, PIGMENT_COLOR);
    expect_color(m->color.colors[0], 0.5, 0.6, 0.7);
    assert_int_equal(imported.report.missing_textures, 1);
    assert_non_null(strstr(imported.report.missing_names, "nowhere.png"));
    release_imported(&imported);
    /* A path of another machine: the picture lies beside the mesh. */
    imported = import_mtl("Kd 0.5 0.6 0.7\nmap_Kd C:\\models\\old\\a.png\nillum 1");
    assert_int_equal(imported.report.missing_textures, 0);
    assert_string_equal(imported.fragment.textures[0].path, "d/a.png");
    release_imported(&imported);
    imported = import_mtl("Kd 0.5 0.6 0.7\nmap_Kd ../../../etc/passwd\nillum 1");
    assert_int_equal(imported.report.missing_textures, 1);
    release_imported(&imported);
}

static void pictures_of_unknown_kinds_are_left_out(void **state)
{
    char expected[256];
    (void)state;
    struct imported imported = import_mtl("map_Kd a.ktx2\nbump a.ktx2");
    assert_int_equal(imported.report.missing_textures, 0);
    assert_int_equal(imported.fragment.texture_count, 0);
    snprintf(expected, sizeof expected, "texture a.ktx2 is left out: it is KTX2 (%s are read)",
             raster_kinds);
    assert_string_equal(imported.report.notes, expected);
    release_imported(&imported);
    imported = import_mtl("map_Kd b.webp\nbump a.ktx2");
    snprintf(expected, sizeof expected,
             "texture b.webp, which is of an unknown kind, and 1 more are left out (%s are read)",
             raster_kinds);
    assert_string_equal(imported.report.notes, expected);
    release_imported(&imported);
}

static void letter_case_of_pictures_is_forgiven(void **state)
{
    (void)state;
    struct imported imported = import_mtl("map_Kd A.PNG\nbump Sub/B C.png\nmap_d A.PNG");
    assert_int_equal(imported.report.missing_textures, 0);
    assert_int_equal(imported.fragment.texture_count, 3); /* a.png as colours and as numbers */
    for (size_t i = 0; i < 3; i++)
        assert_true(strcmp(imported.fragment.textures[i].path, "d/a.png") == 0 ||
                    strcmp(imported.fragment.textures[i].path, "d/sub/b c.png") == 0);
    assert_non_null(
        strstr(imported.report.notes, "2 textures are found under a name of other letter case ("));
    release_imported(&imported);
    imported = import_mtl("map_Kd A.KTX2");
    assert_non_null(strstr(imported.report.notes, "texture A.KTX2 is left out: it is KTX2"));
    assert_non_null(strstr(imported.report.notes, "other letter case (A.KTX2)"));
    release_imported(&imported);
}

static void make_file(const char *folder, const char *name, const char *text)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void letter_case_is_forgiven_on_disk(void **state)
{
    const char *folder = ((struct scratch *)*state)->directory;
    char path[4096], expected[4200];
    snprintf(path, sizeof path, "%s/m.obj", folder);
    snprintf(expected, sizeof expected, "%s/Wall.Png", folder);
    make_file(folder, "m.obj", triangle);
    make_file(folder, "m.mtl", "newmtl m\nmap_Kd WALL.PNG\nbump nowhere.png\n");
    make_file(folder, "Wall.Png", PNG_START);
    struct mesh_request request = request_all(path);
    struct imported imported = import_disk(&request);
    expect_success(&imported);
    assert_string_equal(imported.report.missing_names, "nowhere.png");
    assert_string_equal(imported.fragment.textures[0].path, expected);
    assert_string_equal(imported.report.notes,
                        "1 texture is found under a name of other letter case (WALL.PNG)");
    release_imported(&imported);
}

/* Each once, the first twenty by name. */
static void all_missing_textures_are_named(void **state)
{
    (void)state;
    struct imported imported = import_mtl("map_Kd one.png\nmap_d two.png\nbump one.png");
    assert_int_equal(imported.report.missing_textures, 2);
    assert_string_equal(imported.report.missing_names, "one.png, two.png");
    release_imported(&imported);
    /* Long names, and each twice. */
    char text[8000] = "";
    for (int i = 0; i < 44; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "map_Kd %090d.png\nnewmtl m%d\n",
                 i % 22, i);
    imported = import_mtl(text);
    assert_int_equal(imported.report.missing_textures, 22);
    assert_non_null(strstr(imported.report.missing_names, "018.png, 000"));
    assert_string_equal(strrchr(imported.report.missing_names, ' ') + 89, "19.png");
    release_imported(&imported);
}

static void absent_material_has_but_a_name(void **state)
{
    (void)state;
    struct mesh_request request = request_all("m.obj");
    const struct mesh_memory_file files[] = {
        text_file("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl there\nf 1 2 3\n"
                           "usemtl lamp\nf 1 2 3\n"),
        text_file("m.mtl", "newmtl there\nKd 1 0 0\n")};
    struct imported imported = import_files(&request, files, 2);
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 2);
    const struct material_description *materials = imported.fragment.materials;
    assert_false(material_is_absent(&materials[imported.fragment.objects[0].material]));
    assert_true(material_is_absent(&materials[imported.fragment.objects[1].material]));
    assert_string_equal(materials[imported.fragment.objects[1].material].name, "lamp");
    assert_non_null(strstr(imported.report.notes, "lamp"));
    release_imported(&imported);
    imported = import_files(&request, files, 1); /* without its library */
    expect_success(&imported);
    assert_true(material_is_absent(&imported.fragment.materials[0]));
    assert_non_null(strstr(imported.report.notes, "cannot read its library m.mtl"));
    assert_non_null(strstr(imported.report.notes, "no library"));
    release_imported(&imported);
}

/* assimp alone crashes here. */
static void statements_before_the_first_material_are_harmless(void **state)
{
    (void)state;
    struct mesh_request request = request_all("m.obj");
    const struct mesh_memory_file files[] = {
        text_file("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"),
        text_file("m.mtl", "map_Kd a.png\naniso 1\n  bump b.png\nnewmtl m\nKd 1 0 0\n")};
    struct imported imported = import_files(&request, files, 2);
    expect_success(&imported);
    expect_color(material_named(&imported, "m")->color.colors[0], 1, 0, 0);
    release_imported(&imported);
}

/* Here too. */
int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kd_is_diffuse),
        cmocka_unit_test(reflectances_above_1_are_told),
        cmocka_unit_test(ke_is_radiance),
        cmocka_unit_test(ks_with_illum_2_is_a_coat),
        cmocka_unit_test(colors_may_be_srgb),
        cmocka_unit_test(bumps_are_scaled),
        cmocka_unit_test(almost_black_kd_under_a_mirror_is_black),
        cmocka_unit_test(mirror_over_kd_is_a_mix),
        cmocka_unit_test(refracting_illum_is_glass),
        cmocka_unit_test(d_and_tr_are_opacity),
        cmocka_unit_test(maps_are_textures),
        cmocka_unit_test(picture_of_colour_and_opacity_gives_its_alpha),
        cmocka_unit_test(bump_grows_with_the_unit),
        cmocka_unit_test(missing_texture_is_reported),
        cmocka_unit_test(pictures_of_unknown_kinds_are_left_out),
        cmocka_unit_test(letter_case_of_pictures_is_forgiven),
        SCRATCH_TEST(letter_case_is_forgiven_on_disk),
        cmocka_unit_test(all_missing_textures_are_named),
        cmocka_unit_test(absent_material_has_but_a_name),
        cmocka_unit_test(statements_before_the_first_material_are_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
