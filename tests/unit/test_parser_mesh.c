/* test_parser_mesh.c: mesh files in scenes: what is taken of them, and what replaces it. */
#include "parser_fixture.h"

#include "scratch.h"

#undef MATERIALS
#define MATERIALS "materials: {white: {diffuse: 0.5}, black: {diffuse: 0}}\n"

/* Two triangles, of materials that the file says are red and blue. */
static const char obj[] = "mtllib m.mtl\n"
                          "v 0 0 0\nv 1 0 0\nv 0 0 1\n"
                          "usemtl red\nf 1 2 3\n"
                          "usemtl blue\nf 3 2 1\n";
static const char mtl[] = "newmtl red\nKd 0.5 0 0\nnewmtl blue\nKd 0 0 0.25\n";

/* A scene whose objects are these, with each @ for the path of the mesh file. */
static const char *scene(void **state, const char *objects)
{
    static char text[8192];
    scratch_store(scratch_path(state, "m.obj"), obj, strlen(obj));
    scratch_store(scratch_path(state, "m.mtl"), mtl, strlen(mtl));
    strcpy(text, HEAD);
    for (const char *p = objects; *p; p++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, *p == '@' ? "%s" : "%.1s",
                 *p == '@' ? scratch_path(state, "m.obj") : p);
    }
    return text;
}

static const struct material_description *material_of(const struct scene_description *d,
                                                      const struct object_description *object)
{
    assert_true(object->material < d->material_count);
    return &d->materials[object->material];
}

static void test_materials(void **state)
{
    struct scene_description d = parse_good(
        scene(state,
              "objects:\n"
              "  - mesh: {file: @, translate: [0, 0, 5]}\n"
              "  - mesh: {file: @, material: white}\n"
              "  - mesh: {file: @, materials: {red: black}, camera: no}\n"
              "  - mesh: {file: @, use: [geometry], material: white, materials: {blue: black}}\n"));
    assert_int_equal(d.object_count, 8);
    static const char *const names[] = {"red",   "blue", "white", "white",
                                        "black", "blue", "white", "black"};
    for (size_t i = 0; i < 8; i++) {
        assert_int_equal(d.objects[i].kind, OBJECT_MESH);
        assert_true(d.objects[i].mesh < d.mesh_count);
        assert_int_equal(d.meshes[d.objects[i].mesh].triangle_count, 1);
        assert_string_equal(material_of(&d, &d.objects[i])->name, names[i]);
        assert_true(d.objects[i].hidden == (i == 4 || i == 5));
        assert_int_equal(d.objects[i].origin.line, 6 + (int)(i / 2));
    }
    assert_true(material_of(&d, &d.objects[1])->color.colors[0].b == 0.25F);
    assert_int_equal(d.material_count, 2 + 2 + 1);
    const struct object_description *first = &d.objects[0];
    ps_vec3 p = affine_point(&first->placement, d.meshes[first->mesh].vertices[0]);
    assert_true(p.z >= 5 && p.z <= 6);
    scene_description_release(&d);
}

static void test_options_of_mtl(void **state)
{
    struct scene_description d =
        parse_good(scene(state, "objects: [mesh: {file: @, colors: srgb, bump_scale: 0.5}]\n"));
    assert_float_equal(material_of(&d, &d.objects[0])->color.colors[0].r, 0.2140411, 1e-6);
    scene_description_release(&d);
}

static void test_smooth_angle(void **state)
{
    struct scene_description d =
        parse_good(scene(state, "objects: [mesh: {file: @, smooth_angle: 40}]\n"));
    assert_non_null(d.meshes[d.objects[0].mesh].normals);
    scene_description_release(&d);
    d = parse_good(scene(state, "objects: [mesh: {file: @}]\n"));
    assert_null(d.meshes[d.objects[0].mesh].normals);
    scene_description_release(&d);
}

static void test_in_groups(void **state)
{
    struct scene_description d = parse_good(
        scene(state, "groups: {g: [mesh: {file: @, unit: 2}], h: [instance: {of: g}]}\n"
                     "objects: [group: {translate: [7, 0, 0], objects: [mesh: {file: @}]}]\n"));
    assert_int_equal(d.groups[0].object_count, 2);
    assert_int_equal(d.groups[1].object_count, 2);
    assert_int_equal(d.groups[1].objects[1].mesh, d.groups[0].objects[1].mesh);
    const struct object_description *object = &d.objects[0];
    ps_vec3 p = affine_point(&object->placement, d.meshes[object->mesh].vertices[0]);
    assert_true(p.x >= 7 && p.x <= 8);
    scene_description_release(&d);
}

static void expect(void **state, const char *objects, const char *expected)
{
    const char *text = scene(state, objects);
    struct scene_description d;
    char messages[LONGEST_OUTPUT];
    assert_int_equal(parse(text, strlen(text), &d, messages), PS_ERROR_INVALID);
    if (!strstr(messages, expected))
        fail_msg("%s\nexpected:\n%s", messages, expected);
}

/* Where the scene does not give a material either. */
static void test_parts_without_a_material(void **state)
{
    const char *text = scene(state, "objects:\n  - mesh: {file: @, use: [geometry]}\n"
                                    "  - mesh: {file: @, use: [geometry], material: white}\n");
    struct scene_description d;
    char messages[LONGEST_OUTPUT];
    assert_int_equal(parse(text, strlen(text), &d, messages), PS_OK);
    assert_int_equal(strncmp(messages, "6:5: warning: ", 14), 0);
    const char *rest = strstr(messages, ": 2 parts without a material: grey, of reflectance 0.5; "
                                        "'material' gives another\n");
    assert_non_null(rest);
    assert_ptr_equal(strchr(rest, '\n') + 1, messages + strlen(messages));
    for (size_t i = 0; i < 4; i++) {
        const struct material_description *material = material_of(&d, &d.objects[i]);
        assert_true(material->kind == MATERIAL_DIFFUSE && material->color.colors[0].r == 0.5F);
        assert_true((material->name != NULL) == (i >= 2));
    }
    assert_string_equal(d.meshes[d.objects[3].mesh].file, scratch_path(state, "m.obj"));
    scene_description_release(&d);
}

static void test_errors(void **state)
{
    expect(state, "objects: [mesh: {materials: {bleu: black, red: schwarz}, file: @}]",
           "5:30: error: the mesh file has no material 'bleu'; did you mean 'blue'?\n");
    expect(state, "objects: [mesh: {materials: {bleu: black, red: schwarz}, file: @}]",
           "5:48: error: undefined material 'schwarz'\n");
    expect(state, "objects: [mesh: {use: [geometri, lights], unit: 0, up: w}]",
           "5:11: error: missing key 'file' in mesh\n"
           "5:24: error: use in mesh: expected a list of geometry, materials, camera, lights, got "
           "'geometri'; did you mean 'geometry'?\n"
           "5:49: error: unit in mesh: expected number > 0, got '0'\n"
           "5:56: error: up in mesh: expected x | y | z, got 'w'\n");
    expect(state, "objects: [mesh: {file: @, colors: rgb, bump_scale: -1}]",
           "error: colors in mesh: expected linear | srgb, got 'rgb'");
    expect(state, "objects: [mesh: {file: @, smooth_angle: 200}]",
           "error: smooth_angle in mesh: expected number 0..180, got '200'");
    expect(state, "objects: [mesh: {file: @, bump_scale: -1}]",
           "error: bump_scale in mesh: expected number >= 0, got '-1'");
    expect(state, "groups: {g: [mesh: {use: [lights], file: @}]}",
           "5:26: error: use in mesh: a group holds no cameras and no lights\n");
    expect(state, "objects: [mesh: {file: /nonexistent.obj}]", "5:24: error: ");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_materials),
        SCRATCH_TEST(test_options_of_mtl),
        SCRATCH_TEST(test_smooth_angle),
        SCRATCH_TEST(test_in_groups),
        SCRATCH_TEST(test_parts_without_a_material),
        SCRATCH_TEST(test_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
