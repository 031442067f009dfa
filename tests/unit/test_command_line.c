/* test_command_line.c: what --param and --set do to a scene. */
#include "language_fixture.h"

#include <unistd.h>

#define TABLE                                                                                      \
    "psd: 1\n" CAMERA LIGHTS "materials: {white: {diffuse: 0.5}, ': #a': {diffuse: 1}}\n"          \
    "parameters:\n"                                                                                \
    "  height: {default: 2.5, help: height of the table}\n"                                        \
    "  legs: {type: number}\n"                                                                     \
    "  at: {default: [1, =height, 3]}\n"                                                           \
    "  surface: {default: white}\n"                                                                \
    "define: {r: =height/2}\n"                                                                     \
    "objects:\n"                                                                                   \
    "  - for: i\n    from: 1\n    to: =legs\n"                                                     \
    "    do: {sphere: {center: =at, radius: =r, material: =surface}}\n"

static void test_parameters(void **state)
{
    (void)state;
    struct reading reading = {.parameters = {"legs=3"}};
    struct scene_description d = expect_good(TABLE, &reading);
    assert_int_equal(d.object_count, 3);
    assert_true(d.objects[0].radius == 1.25);
    assert_vector(d.objects[0].center, 1, 2.5, 3);
    scene_description_release(&d);
    reading = (struct reading){
        .parameters = {"height=9", "legs=2", "surface=: #a", "at=[=height, 0, 1]", "height==2*4"}};
    d = expect_good(TABLE, &reading);
    assert_int_equal(d.object_count, 2);
    assert_true(d.objects[0].radius == 4);
    assert_vector(d.objects[1].center, 8, 0, 1);
    assert_string_equal(d.materials[d.objects[1].material].name, ": #a");
    scene_description_release(&d);
}

static void test_bad_parameters(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        struct reading reading;
        const char *messages;
    } cases[] = {
        {TABLE,
         {0},
         "t:7:3: error: parameter 'legs' has no default; give it with --param legs=NUMBER\n"},
        {TABLE,
         {.parameters = {"legs=3", "hieght=3", "foo=1"}},
         "--param:2:1: error: unknown parameter 'hieght'; did you mean 'height'?\n"
         "--param:3:1: error: unknown parameter 'foo'; declared are height, legs, at, surface\n"},
        {HEAD,
         {.parameters = {"a=3"}},
         "--param:1:1: error: unknown parameter 'a'; the scene declares none\n"},
        {TABLE,
         {.parameters = {"legs=four", "at=3"}},
         "--param:1:6: error: parameter 'legs': expected a number, got 'four'\n"
         "--param:2:4: error: parameter 'at': expected [x, y, z], got '3'\n"},
        {TABLE,
         {.parameters = {"legs=3", "height=[1, 2, 3]"}},
         "--param:2:8: error: parameter 'height': expected a number, got a list\n"},
        {TABLE,
         {.parameters = {"legs", "=3"}},
         "--param:1:1: error: expected NAME=VALUE, got 'legs'\n"
         "--param:2:1: error: expected NAME=VALUE, got '=3'\n"},
        {TABLE,
         {.parameters = {"legs=[1", "surface=white"}},
         "--param:1:8: error: did not find expected ',' or ']', while parsing a flow sequence that "
         "begins at line 1, column 6\n"},
        {TABLE,
         {.parameters = {"surface=whit", "legs==1/0"}},
         "--param:2:8: error: division by zero\n"},
        {TABLE,
         {.parameters = {"surface=whit", "legs=1"}},
         "--param:1:9: error: undefined material 'whit'; did you mean 'white'?\n"},
        {TABLE,
         {.parameters = {"surface=\xff"}},
         "--param:1:9: error: byte 0xff is not UTF-8; save the scene as UTF-8\n"},
        {HEAD "parameters:\n  a: 3\n  b: {type: vector, default: 3}\n  c: {typ: number}\n"
              "  d: {default: [1, 2]}\n  e: {default: 1, help: []}\n  f: {type: text, default: x}\n"
              "  sin: {default: 1}\n",
         {.parameters = {"c=1"}},
         "t:6:6: error: expected a map for parameter, got text\n"
         "t:7:30: error: default of parameter 'b': expected [x, y, z], got '3'\n"
         "t:8:7: error: unknown key 'typ' in parameter; did you mean 'type'?\n"
         "t:9:16: error: default of parameter 'd': expected a number, [x, y, z] or text, got a "
         "list\n"
         "t:10:25: error: help in parameter: expected text, got a list\n"
         "t:11:13: error: type in parameter: expected auto | number | vector | string, got 'text'\n"
         "t:12:3: error: the name 'sin' is taken: arithmetic has a meaning for it\n"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect_bad(cases[i].text, &cases[i].reading, cases[i].messages);
}

static void collect(void *user, const struct psd_parameter *parameter)
{
    char *text = user;
    sprintf(text + strlen(text), "%s %s %s %s\n", parameter->name, parameter->type,
            parameter->default_value ? parameter->default_value : "-",
            parameter->help ? parameter->help : "-");
}

static void test_list_of_parameters(void **state)
{
    (void)state;
    static const char scene[] = TABLE "nonsense: [\n";
    char path[] = "/tmp/psplat-test-XXXXXX", listed[1024] = "";
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, scene, sizeof TABLE - 1), sizeof TABLE - 1);
    close(file);
    struct diagnostics *sink = diagnostics_create();
    assert_int_equal(psd_list_parameters(path, NULL, sink, collect, listed), PS_OK);
    assert_string_equal(listed, "height number 2.5 height of the table\n"
                                "legs number - -\n"
                                "at vector [1, 2.5, 3] -\n"
                                "surface string white -\n");
    diagnostics_destroy(sink);
    remove(path);
}

static void test_sets(void **state)
{
    (void)state;
    struct reading reading = {.sets = {"image.width=400", "materials.white.diffuse=0.25",
                                       "render.passes==2^4", "lights.0.point.intensity=[1, 2, 3]",
                                       "objects.1={sphere: {center: [1, 2, 3], "
                                       "radius: 2, material: white}}",
                                       "define.n=7", "image.width=500",
                                       "render.injection={photon: {count: 5}}"}};
    struct scene_description d = expect_good(
        HEAD "define: {n: 1}\nobjects:\n  - &a {sphere: &s {center: [0, 0, 0], radius: =n, "
             "material: white}}\n  - *a\n  - sphere: {<<: *s, material: white}\n",
        &reading);
    assert_int_equal(d.image.width, 500);
    assert_int_equal(d.image.height, 450);
    assert_true(d.materials[0].color.colors[0].r == 0.25F);
    assert_true(d.lights[0].amount.b == 3);
    assert_true(d.render.passes.choice < 0 && d.render.passes.number == 16);
    assert_true(d.objects[0].radius == 7);
    assert_true(d.objects[1].radius == 2);
    assert_true(d.objects[2].radius == 7);
    assert_string_equal(d.objects[1].origin.file, "--set");
    assert_string_equal(d.render.strategies[0].parameters[0].value, "5");
    scene_description_release(&d);
    /* An alias is a copy. */
    reading = (struct reading){.sets = {"objects.0.sphere.radius=3"}};
    d = expect_good(HEAD
                    "objects:\n  - sphere: &s {center: [0, 0, 0], radius: 1, material: white}\n"
                    "  - sphere: *s\n",
                    &reading);
    assert_true(d.objects[0].radius == 3 && d.objects[1].radius == 1);
    scene_description_release(&d);
}

static void test_bad_sets(void **state)
{
    (void)state;
    static const struct {
        struct reading reading;
        const char *messages;
    } cases[] = {
        {{.sets = {"image.width=wide"}},
         "--set:1:13: error: width in image: expected integer 1..65536, got 'wide'\n"},
        {{.sets = {"image.height=1", "image.widht=3", "imgae.width=3"}},
         "--set:2:7: error: unknown key 'widht' in image; did you mean 'width'?\n"
         "--set:3:1: error: unknown key 'imgae' in scene; did you mean 'image'?\n"},
        {{.sets = {"lights.1.point.intensity=2", "lights.x=2", "objects.0=3", "lights.-1=3",
                   "lights.99999999999999999999999=3"}},
         "--set:1:8: error: 'lights' has no item 1; it has 1, counted from 0\n"
         "--set:2:8: error: 'lights' is a list; expected the number of an item, got 'x'\n"
         "--set:3:9: error: 'objects' is an empty list\n"
         "--set:4:8: error: 'lights' is a list; expected the number of an item, got '-1'\n"
         "--set:5:8: error: 'lights' has no item 99999999999999999999999; it has 1, counted from "
         "0\n"},
        {{.sets = {"render.injection.photon.count=5", "psd.x=1"}},
         "--set:1:18: error: 'render.injection' is text, in which there is no 'photon'\n"
         "--set:2:5: error: 'psd' is text, in which there is no 'x'\n"},
        {{.sets = {"image..width=3", "image.=3", ".image=3", "image", "=5"}},
         "--set:4:1: error: expected NAME=VALUE, got 'image'\n"
         "--set:5:1: error: expected NAME=VALUE, got '=5'\n"},
        {{.sets = {"image..width=3", "image.=3", ".image=3"}},
         "--set:1:7: error: a key is missing in 'image..width'\n"
         "--set:2:7: error: a key is missing in 'image.'\n"
         "--set:3:1: error: a key is missing in '.image'\n"},
        {{.sets = {"image.width={", "include=a.psd", "include.0=a"}},
         "--set:1:14: error: did not find expected node content, while parsing a flow node that "
         "begins at line 1, column 14\n"
         "--set:2:1: error: include can't be set: the files have been read by then\n"
         "--set:3:1: error: include can't be set: the files have been read by then\n"},
        {{.sets = {"image.height=1\n", "image.w\xc3\xa4=*a"}},
         "--set:3:7: error: unknown key 'w\xc3\xa4' in image\n"
         "--set:3:10: error: undefined alias '*a'\n"},
        {{.sets =
              {"a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a."
               "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a=1"}},
         "--set:1:129: error: nested deeper than 64 levels\n"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect_bad(HEAD "image: {width: 3}\nobjects: []\nrender: {injection: photon}\n",
                   &cases[i].reading, cases[i].messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parameters),         cmocka_unit_test(test_bad_parameters),
        cmocka_unit_test(test_list_of_parameters), cmocka_unit_test(test_sets),
        cmocka_unit_test(test_bad_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
