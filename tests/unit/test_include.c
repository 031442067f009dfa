/* test_include.c: scenes of several files. */
#include "language_fixture.h"
#include "scratch.h"

#include <fcntl.h>

static void test_sections_go_together(void **state)
{
    (void)state;
    static const struct memory_file files[] = {
        {"lib/all.psd", "psd: 1\ninclude: [wood.psd, ../lamp.psd]\n"
                        "camera: {location: [5, 5, 5], look_at: [1, 1, 1], up: [0, 0, 1]}\n"
                        "image: {width: 30, height: 20, exposure: 1}\n"
                        "define: {r: =wood_r * 2}\n"
                        "objects: [{sphere: {center: [2, 0, 0], radius: =r, material: oak}}]\n"},
        {"lib/wood.psd", "psd: 1\nmaterials: {oak: {diffuse: 0.25}}\ndefine: {wood_r: 4}\n"
                         "objects: [{sphere: {center: [1, 0, 0], radius: 1, material: oak}}]\n"
                         "image: {width: 10, height: 10}\nrender:\nlights:\n"},
        {"lib/../lamp.psd", "psd: 1\nlights: [{point: {location: [1, 1, 1], intensity: 1}}]\n"},
        {NULL, NULL}};
    const struct reading reading = {.files = files};
    struct scene_description d = expect_good(
        "psd: 1\ninclude: lib/all.psd\ncamera: {location: [0, 0, -1], look_at: [0, 0, 0]}\n"
        "image: {width: 40}\nrender: {passes: 2}\nmaterials: {white: {diffuse: 0.5}}\n"
        "lights: [{point: {location: [2, 2, 2], intensity: 1}}]\n"
        "objects: [{sphere: {center: [3, 0, 0], radius: =r/8, material: white}}]\n",
        &reading);
    assert_int_equal(d.object_count, 3);
    for (int i = 0; i < 3; i++)
        assert_vector(d.objects[i].center, i + 1, 0, 0);
    assert_true(d.objects[1].radius == 8 && d.objects[2].radius == 1);
    assert_int_equal(d.material_count, 2);
    assert_int_equal(d.light_count, 2);
    assert_vector(d.lights[1].location, 2, 2, 2);
    /* The including file goes before what it includes: key by key, but a camera is one thing. */
    assert_int_equal(d.image.width, 40);
    assert_int_equal(d.image.height, 20);
    assert_true(d.image.exposure == 1);
    assert_true(d.render.passes.choice < 0 && d.render.passes.number == 2);
    assert_vector(d.cameras[0].location, 0, 0, -1);
    assert_vector(d.cameras[0].up, 0, 1, 0);
    assert_string_equal(d.path, "t");
    assert_string_equal(d.objects[0].origin.file, "lib/wood.psd");
    assert_int_equal(d.objects[0].origin.line, 4);
    assert_string_equal(d.lights[0].origin.file, "lib/../lamp.psd");
    assert_string_equal(d.objects[2].origin.file, "t");
    scene_description_release(&d);
}

/* Files that a scene names lie beside who wrote their names. */
static void test_paths_follow_their_files(void **state)
{
    (void)state;
    static const struct memory_file files[] = {
        {"lib/wood.psd", "psd: 1\nparameters: {grain: {type: string, default: grain.png}}\n"
                         "define: {bark: bark.png, oak: {diffuse: {image: {file: =bark}}}}\n"
                         "materials: {elm: {diffuse: {image: {file: elm.png}}},\n"
                         "  ash: {diffuse: {image: {file: =grain}}},\n"
                         "  box: {diffuse: {image: {file: /box.png}}}}\n"},
        {NULL, NULL}};
    static const char scene[] =
        "psd: 1\ninclude: lib/wood.psd\n" CAMERA LIGHTS
        "materials: {oak: =oak, fir: {diffuse: {image: {file: fir.png}}}}\n";
    struct reading reading = {.files = files};
    struct scene_description d = expect_good(scene, &reading);
    assert_int_equal(d.texture_count, 5);
    assert_string_equal(d.textures[0].path, "lib/elm.png");
    assert_string_equal(d.textures[1].path, "lib/grain.png");
    assert_string_equal(d.textures[2].path, "/box.png");
    assert_string_equal(d.textures[3].path, "lib/bark.png");
    assert_string_equal(d.textures[4].path, "fir.png");
    scene_description_release(&d);
    reading.parameters[0] = "grain=mine/ash.png";
    reading.sets[0] = "materials.box.diffuse.image.file=new.png";
    d = expect_good(scene, &reading);
    assert_string_equal(d.textures[1].path, "mine/ash.png");
    assert_string_equal(d.textures[2].path, "new.png");
    scene_description_release(&d);
}

static void test_groups_and_cameras_go_together(void **state)
{
    (void)state;
    static const struct memory_file files[] = {
        {"a.psd", "psd: 1\ngroups: {ball: [{sphere: {center: [0, 0, 0], radius: 1, "
                  "material: white}}]}\ncameras: {top: {location: [0, 9, 0], look_at: [0, 0, 0], "
                  "up: [1, 0, 0]}}\n"},
        {NULL, NULL}};
    const struct reading reading = {.files = files};
    struct scene_description d = expect_good(
        HEAD "include: a.psd\ngroups: {two: [{for: i, from: 0, to: 1, do: {instance: {of: ball, "
             "translate: [=i, 0, 0]}}}]}\ncameras: {side: {location: [9, 0, 0], look_at: [0, 0, "
             "0]}}\nobjects: [{for: g, in: [ball, two], do: {instance: {of: =g}}}]\n",
        &reading);
    assert_int_equal(d.group_count, 2);
    assert_int_equal(d.camera_count, 3);
    assert_string_equal(d.cameras[1].name, "top");
    assert_int_equal(d.object_count, 2);
    scene_description_release(&d);
    expect_bad(HEAD "include: a.psd\ngroups: {ball: []}\ncameras: {top: {}}\n", &reading,
               "t:6:10: error: duplicate name 'ball' in groups; the first is in a.psd, line 2\n"
               "t:7:11: error: duplicate name 'top' in cameras; the first is in a.psd, line 3\n");
}

static void test_a_file_is_read_once(void **state)
{
    (void)state;
    static const struct memory_file files[] = {
        {"a.psd", "psd: 1\ninclude: base.psd\n"},
        {"b.psd", "psd: 1\ninclude: base.psd\n"},
        {"base.psd", "psd: 1\nmaterials: {oak: {diffuse: 0.25}}\n"
                     "objects: [{sphere: {center: [1, 0, 0], radius: 1, material: oak}}]\n"},
        {NULL, NULL}};
    const struct reading reading = {.files = files};
    struct scene_description d =
        expect_good(HEAD "include: [a.psd, b.psd, base.psd, a.psd]\n", &reading);
    assert_int_equal(d.object_count, 1);
    assert_int_equal(d.material_count, 2);
    scene_description_release(&d);
}

static void test_messages_name_their_files(void **state)
{
    (void)state;
    static const struct memory_file files[] = {
        {"lib/a.psd", "psd: 1\n\ninclude:\n - b.psd\n"},
        {"lib/b.psd", "psd: 1\nmaterials:\n  white: {diffuse: 0.5}\n  red: {diffus: 1}\n"
                      "define: {n: =1/0, k: 2}\nparameters: {height: {default: 1}}\n"},
        {"lib/c.psd", "psd: 1\n"},
        {"plain.psd", "materials: {}"},
        {"two.psd", "psd: 2\nwhat: ever"},
        {"list.psd", "- psd: 1"},
        {"broken.psd", "psd: 1\nmaterials: {"},
        {"list_of_materials.psd", "psd: 1\nmaterials: []\nobjects: {}\nimage: 3"},
        {NULL, NULL}};
    static const struct bad cases[] = {
        {HEAD "include: lib/a.psd\ndefine: {n: 1}\nparameters: {k: {default: 3}}\n",
         "t:4:13: error: duplicate name 'white' in materials; the first is in lib/b.psd, line 3\n"
         "t:6:10: error: duplicate name 'n' in define; the first is in lib/b.psd, line 5\n"
         "In file included from lib/a.psd:4:4:\n"
         "                 from t:5:10:\n"
         "lib/b.psd:4:3: error: material needs one of diffuse, mirror, metal, glossy, dielectric, "
         "mix\n"
         "lib/b.psd:4:9: error: unknown key 'diffus' in material; did you mean 'diffuse'?\n"
         "lib/b.psd:5:15: error: division by zero\n"
         "lib/b.psd:5:19: error: the name 'k' is taken in t, line 7\n"},
        {HEAD "include: plain.psd", "t:5:10: error: can't include 'plain.psd': it is no scene, "
                                    "since it has no key 'psd'\n"},
        {HEAD "include: two.psd",
         "In file included from t:5:10:\n"
         "two.psd:1:6: error: psd version 2 is unknown; this psplat reads version 1\n"},
        {HEAD "include: list.psd", "t:5:10: error: can't include 'list.psd': it is no scene, "
                                   "since it has no key 'psd'\n"},
        {HEAD "include: broken.psd\nimage: {width: x}",
         "In file included from t:5:10:\n"
         "broken.psd:2:13: error: did not find expected node content, while parsing a flow node "
         "that begins at line 2, column 13\n"},
        {HEAD "include: list_of_materials.psd\nobjects: []\nimage: {}",
         "t:4:12: error: materials is a map here, and a list in list_of_materials.psd, line 2\n"
         "t:6:10: error: objects is a list here, and a map in list_of_materials.psd, line 3\n"
         "t:7:8: error: image is a map here, and text in list_of_materials.psd, line 4\n"
         "In file included from t:5:10:\n"
         "list_of_materials.psd:2:12: error: expected a map for materials, got a list\n"
         "list_of_materials.psd:3:10: error: expected a list for objects, got a map\n"
         "list_of_materials.psd:4:8: error: expected a map for image, got text\n"},
        {"psd: 1\ninclude: lib/c.psd\n" LIGHTS, "t:1:1: error: missing key 'camera' in scene\n"},
        {HEAD "include: [gone.psd, lib/gone.psd]\nimage: {width: x}",
         "t:5:11: error: can't include 'gone.psd': not there\n"
         "t:5:21: error: can't include 'lib/gone.psd': not there\n"},
        {HEAD "include: {a: b}",
         "t:5:10: error: include in scene: expected the path of a file, got a map\n"},
        {HEAD "include: [[a], =b, \"\"]",
         "t:5:11: error: include in scene: expected the path of a file, got a list\n"
         "t:5:16: error: include in scene: the path of a file can't be a formula\n"
         "t:5:20: error: include in scene: expected the path of a file, got text\n"}};
    const struct reading reading = {.files = files};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect_bad(cases[i].text, &reading, cases[i].messages);
}

static void test_anchors_end_with_their_file(void **state)
{
    (void)state;
    static const struct memory_file files[] = {
        {"a.psd", "psd: 1\nmaterials: {oak: &oak {diffuse: 0.25}}\n"}, {NULL, NULL}};
    const struct reading reading = {.files = files};
    expect_bad("psd: 1\ninclude: a.psd\n" CAMERA LIGHTS "materials: {elm: *oak}\n", &reading,
               "t:5:18: error: undefined alias '*oak'\n");
}

static void test_cycles_and_depth(void **state)
{
    (void)state;
    static const struct memory_file cycle[] = {{"a.psd", "psd: 1\ninclude: b.psd\n"},
                                               {"b.psd", "psd: 1\ninclude: [c.psd]\n"},
                                               {"c.psd", "psd: 1\ninclude: [b.psd, a.psd, t]\n"},
                                               {"t", "psd: 1\n"},
                                               {NULL, NULL}};
    const struct reading in_cycle = {.files = cycle};
    expect_bad(HEAD "include: a.psd", &in_cycle,
               "In file included from b.psd:2:11:\n"
               "                 from a.psd:2:10:\n"
               "                 from t:5:10:\n"
               "c.psd:2:11: error: 'b.psd' includes itself: b.psd -> c.psd -> b.psd\n"
               "c.psd:2:18: error: 'a.psd' includes itself: a.psd -> b.psd -> c.psd -> a.psd\n"
               "c.psd:2:25: error: 't' includes itself: t -> a.psd -> b.psd -> c.psd -> t\n");
    struct memory_file tower[18] = {{NULL, NULL}};
    char paths[18][16], texts[18][64];
    for (int i = 0; i < 17; i++) {
        snprintf(paths[i], sizeof paths[i], "f%d.psd", i);
        snprintf(texts[i], sizeof texts[i], "psd: 1\ninclude: f%d.psd\n", i + 1);
        tower[i] = (struct memory_file){paths[i], texts[i]};
    }
    const struct reading in_tower = {.files = tower};
    struct scene_description d;
    char messages[LONGEST_OUTPUT];
    assert_int_equal(read_as(HEAD "include: f0.psd", &in_tower, &d, messages), PS_ERROR_INVALID);
    assert_non_null(
        strstr(messages, "f15.psd:2:10: error: files are included more than 16 deep\n"));
    strcpy(texts[15], "psd: 1\n");
    d = expect_good(HEAD "include: f0.psd", &in_tower);
    scene_description_release(&d);
}

static ps_result read_empty(void *user, const char *path, size_t most, struct file_text *text,
                            struct error *error)
{
    (void)path, (void)most, (void)error;
    ++*(size_t *)user;
    text->bytes = calloc(1, 8);
    assert_non_null(text->bytes);
    memcpy(text->bytes, "psd: 1", 6);
    text->length = 6;
    return PS_OK;
}

static void expect_end(size_t count, const char *format, size_t *read, const char *message)
{
    static char text[100000], messages[LONGEST_OUTPUT];
    char *at = text + sprintf(text, HEAD "include:\n");
    for (size_t i = 0; i < count; i++)
        at += sprintf(at, format, i);
    const struct psd_files files = {read, read_empty};
    const struct psd_options options = {.files = &files};
    struct scene_description d;
    struct diagnostics *sink = diagnostics_create();
    *read = 0;
    assert_int_equal(psd_read_text_with("t", text, strlen(text), &options, sink, &d),
                     PS_ERROR_INVALID);
    print_all(sink, messages);
    assert_non_null(strstr(messages, message));
    assert_int_equal(diagnostics_error_count(sink), 1);
    diagnostics_destroy(sink);
}

static void test_too_many_files(void **state)
{
    (void)state;
    size_t read;
    expect_end(300, "- f%zu\n", &read, "t:261:3: error: more than 256 files in one scene\n");
    assert_int_equal(read, 256);
    expect_end(5000, "- f\n", &read, "t:4102:3: error: more than 4096 files are included\n");
    assert_int_equal(read, 1); /* a name that is known needs no reading */
}

/* --- the file system
 * --------------------------------------------------------------------------- */

static void write_text(void **state, const char *name, const char *text)
{
    scratch_store(scratch_path(state, name), text, strlen(text));
}

static ps_result read_main(void **state, struct scene_description *d, char printed[LONGEST_OUTPUT])
{
    struct diagnostics *sink = diagnostics_create();
    assert_non_null(sink);
    ps_result result = psd_read_file(scratch_path(state, "main.psd"), sink, d);
    print_all(sink, printed);
    diagnostics_destroy(sink);
    return result;
}

static void test_files_beside_the_scene(void **state)
{
    struct scene_description d;
    char printed[LONGEST_OUTPUT], absolute[600];
    write_text(state, "lib.psd", "psd: 1\nmaterials: {oak: {diffuse: 0.25}}\n");
    snprintf(absolute, sizeof absolute, HEAD "include: [lib.psd, ./lib.psd, %s]\n",
             scratch_path(state, "lib.psd"));
    write_text(state, "main.psd", absolute);
    assert_int_equal(read_main(state, &d, printed), PS_OK);
    assert_int_equal(d.material_count, 2); /* one file under three names */
    scene_description_release(&d);
    write_text(state, "lib.psd", "psd: 1\ninclude: main.psd\n");
    assert_int_equal(read_main(state, &d, printed), PS_ERROR_INVALID);
    assert_non_null(strstr(printed, "main.psd' includes itself: "));
}

/* Neither waits for a pipe, nor reads devices. */
static void test_only_regular_files(void **state)
{
    struct scene_description d;
    char printed[LONGEST_OUTPUT];
    assert_int_equal(mkfifo(scratch_path(state, "pipe"), 0600), 0);
    write_text(state, "main.psd", HEAD "include: [pipe, ., /dev/zero, gone]\n");
    assert_int_equal(read_main(state, &d, printed), PS_ERROR_INVALID);
    assert_non_null(strstr(printed, "/pipe': it is not a regular file\n"));
    assert_non_null(strstr(printed, "/.': it is a directory\n"));
    assert_non_null(strstr(printed, "can't include '/dev/zero': it is not a regular file\n"));
    assert_non_null(strstr(printed, "/gone': cannot open: No such file or directory\n"));
}

static void test_size_is_bounded(void **state)
{
    struct file_text text = {0};
    struct error error;
    write_text(state, "file", "0123456789");
    assert_int_equal(file_read_regular(scratch_path(state, "file"), NULL, 10, &text, &error),
                     PS_OK);
    assert_int_equal(text.length, 10);
    assert_true(text.serial != 0);
    file_release(&text);
    assert_int_equal(file_read_regular(scratch_path(state, "file"), NULL, 9, &text, &error),
                     PS_ERROR_INVALID);
    assert_string_equal(error.text, "larger than 0 MiB");
    file_release(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sections_go_together),
        cmocka_unit_test(test_paths_follow_their_files),
        cmocka_unit_test(test_groups_and_cameras_go_together),
        cmocka_unit_test(test_a_file_is_read_once),
        cmocka_unit_test(test_messages_name_their_files),
        cmocka_unit_test(test_anchors_end_with_their_file),
        cmocka_unit_test(test_cycles_and_depth),
        cmocka_unit_test(test_too_many_files),
        SCRATCH_TEST(test_files_beside_the_scene),
        SCRATCH_TEST(test_only_regular_files),
        SCRATCH_TEST(test_size_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
