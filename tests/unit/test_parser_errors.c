/* test_parser_errors.c: what the parser says about scenes that are wrong.
 *
 * A message that moves or changes must be seen here.
 */
#include "parser_fixture.h"

static void test_arithmetic_errors(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "image: {width: =1/0}", "5:18: error: division by zero\n"},
        {HEAD "image: {width: \"=1/0\"}", "5:19: error: division by zero\n"},
        {HEAD "image: {width: =10^999}", "5:19: error: the result is not a finite number\n"},
        {HEAD "image: {width: =sqrt(-1)}", "5:17: error: the result is not a finite number\n"},
        {HEAD "image: {width: =sqr(1)}",
         "5:17: error: unknown name 'sqr' in arithmetic; did you mean 'sqrt'?\n"},
        {HEAD "image: {width: =(1}", "5:16: error: expected ')' at the end\n"},
        {HEAD "image: {width: =2 3}", "5:19: error: expected an operator, got '3'\n"},
        {HEAD "image: {width: =1.2.3}", "5:17: error: this is not a number\n"},
        {HEAD "image: {width: \"=min(1)\"}", "5:18: error: min takes 2 to 8 arguments, got 1\n"},
        {HEAD "image: {width: =}", "5:16: error: expected a number at the end\n"}};
    EXPECT_ALL(cases);
    char text[600] = HEAD "image: {width: =";
    size_t used = strlen(text);
    memset(text + used, '(', 200);
    text[used + 200] = '}';
    expect_bytes(text, strlen(text), "5:81: error: the arithmetic is nested too deeply\n");
}

static void test_keys(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "lihgts: []", "5:1: error: unknown key 'lihgts' in scene; did you mean 'lights'?\n"},
        {HEAD "version: 1", "5:1: error: unknown key 'version' in scene\n"},
        {HEAD "image:\n  width: 1\n  height: 2\n  width: 3",
         "8:3: error: duplicate key 'width'; the first is on line 6\n"},
        {HEAD "objects:\n  - sphere: {center: [0, 0, 0], radios: 60}",
         "6:5: error: missing key 'radius' in sphere\n"
         "6:5: error: missing key 'material' in sphere\n"
         "6:33: error: unknown key 'radios' in sphere; did you mean 'radius'?\n"},
        {"", "1:1: error: missing key 'psd' in scene\n"
             "1:1: error: missing key 'camera' in scene\n"},
        {"psd: 2\nfoo: 3", "1:6: error: psd version 2 is unknown; this psplat reads version 1\n"},
        {"psd: one\n" CAMERA LIGHTS,
         "1:6: error: psd in scene: expected integer 1..1, got 'one'\n"},
        {"psd: 1\ncamera:\n" LIGHTS, "2:1: error: missing key 'location' in camera\n"},
        {"- psd", "1:1: error: expected a map for scene, got a list\n"},
        {HEAD "? [a]\n: 1", "5:3: error: a key must be text, not a list\n"},
        {HEAD "image: &i {<<: 5}\n",
         "5:16: error: '<<' merges a map or a list of maps, not text\n"},
        {HEAD "image: {<<: [{width: 1}, [2]]}\n",
         "5:26: error: '<<' merges a map or a list of maps, not a list\n"},
        {HEAD "image: {<<: {widht: 1}}\n",
         "5:14: error: unknown key 'widht' in image; did you mean 'width'?\n"}};
    EXPECT_ALL(cases);
}

static void test_values(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "image: {width: wide}",
         "5:16: error: width in image: expected integer 1..65536, got 'wide'\n"},
        {HEAD "image: {width: 65537}",
         "5:16: error: width in image: expected integer 1..65536, got '65537'\n"},
        {HEAD "image: {width: }",
         "5:16: error: width in image: expected integer 1..65536, got nothing\n"},
        {HEAD "image: {exposure: nan}",
         "5:19: error: exposure in image: expected number -20..20, got 'nan'\n"},
        {HEAD "image: {exposure: 1e999}",
         "5:19: error: exposure in image: expected number -20..20, got '1e999'\n"},
        {HEAD "image: {exposure: [1]}",
         "5:19: error: exposure in image: expected number -20..20, got a list\n"},
        {HEAD "image: 5", "5:8: error: expected a map for image, got text\n"},
        {HEAD "render: {passes: 0, seed: -1}",
         "5:18: error: passes in render: expected auto | integer 1..1000000, got '0'\n"
         "5:27: error: seed in render: expected integer 0..9007199254740992, got '-1'\n"},
        {"psd: 1\ncamera: {location: [1, 2], look_at: [0, x, {}], up: 3, angle: 180}\n" LIGHTS,
         "2:20: error: location in camera: expected 3 numbers, got 2\n"
         "2:41: error: look_at in camera: expected a number, got 'x'\n"
         "2:44: error: look_at in camera: expected a number, got a map\n"
         "2:53: error: up in camera: expected [x, y, z] of number, got '3'\n"
         "2:63: error: angle in camera: expected number 0..180 (0 and 180 excluded), got '180'\n"},
        {"psd: 1\nmaterials: {a: {diffuse: [0, 0, 1.5]}, b: [], c: {diffuse: [\"0, 1\", "
         "0]}}\n" CAMERA LIGHTS,
         "2:26: error: diffuse in material: expected [r, g, b] or grey, each number 0..1, got "
         "'[0, 0, 1.5]'\n"
         "2:43: error: expected a map for material, got a list\n"
         "2:60: error: diffuse in material: expected 3 numbers, got 2\n"}};
    EXPECT_ALL(cases);
}

static void test_cameras(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {"psd: 1\ncamera: {location: [1, 2, 3], look_at: [1, 2, 3]}\n" LIGHTS,
         "2:40: error: look_at is the camera's location; it must be another point\n"},
        {"psd: 1\ncamera: {location: [1, 9, 3], look_at: [1, 2, 3]}\n" LIGHTS,
         "2:1: error: up is along the direction of view; the camera's roll is undefined\n"},
        {"psd: 1\ncamera: {location: [1, 9, 3], look_at: [0, 0, 0], up: [0, 0, 0]}\n" LIGHTS,
         "2:55: error: up is along the direction of view; the camera's roll is undefined\n"},
        {"psd: 1\ncamera: {location: [1, 9, 3], look_at: [0, 0, 0], angle: 1, vertical_angle: "
         "1}\n" LIGHTS,
         "2:77: error: camera has both angle and vertical_angle; give one of them\n"},
        {"psd: 1\ncamera: {location: [1, 9, 3], look_at: [0, 0, 0], projection: orthographic, "
         "angle: 9}\n" LIGHTS,
         "2:1: error: missing key 'width' in camera, which an orthographic one requires\n"
         "2:84: error: an orthographic camera has no angle; it has a width\n"},
        {"psd: 1\ncamera: {location: [1, 9, 3], look_at: [0, 0, 0], width: 5, aperture: -1, focus: "
         "0}\n" LIGHTS,
         "2:71: error: aperture in camera: expected number >= 0, got '-1'\n"
         "2:82: error: focus in camera: expected number > 0, got '0'\n"},
        {"psd: 1\ncamera: {location: [1, 9, 3], look_at: [0, 0, 0], width: 5}\n" LIGHTS,
         "2:58: error: width is of an orthographic camera; a perspective one has an angle\n"},
        {"psd: 1\ncamera: {location: automatic, look_at: [0, 0]}\n" LIGHTS,
         "2:20: error: location in camera: expected auto | [x, y, z] of number, got 'automatic'\n"
         "2:40: error: look_at in camera: expected 3 numbers, got 2\n"},
        {"psd: 1\ncamera: {location: auto, up: [0, 0, 0]}\n" LIGHTS,
         "2:30: error: the length of up is 0\n"},
        {"psd: 1\ncamera: {location: [0, 0, 1], projection: orthographic}\n" LIGHTS,
         "2:1: error: missing key 'width' in camera, which an orthographic one requires\n"},
        {"psd: 1\ncamera: automatic\n" LIGHTS,
         "2:9: error: expected auto or a map for camera, got 'automatic'\n"},
        {"psd: 1\n" LIGHTS "cameras: {}\n", "3:1: error: the scene has no camera\n"},
        {"psd: 1\n" CAMERA LIGHTS "cameras: {camera: {location: [0, 0, 1], look_at: [0, 0, 0]}}\n",
         "4:11: error: the camera without a name is called 'camera' already\n"},
        {HEAD "image: {filter: cone}\n",
         "5:17: error: filter in image: expected box | tent | gaussian, got 'cone'\n"}};
    EXPECT_ALL(cases);
}

static void test_lights(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {"psd: 1\n" CAMERA "lights:\n  - spotligt: {}\n  - laser: {}\n  - point\n  - {}\n  - 5: {}",
         "4:5: error: unknown light kind 'spotligt'; did you mean 'spotlight'?\n"
         "5:5: error: unknown light kind 'laser'; known are point, spotlight, sun, rectangle, "
         "disc, "
         "sphere, sky\n"
         "6:5: error: expected a map with one key in lights, got text\n"
         "7:5: error: expected a map with one key in lights, got an empty map\n"
         "8:5: error: unknown light kind '5'; known are point, spotlight, sun, rectangle, disc, "
         "sphere, sky\n"},
        {"psd: 1\n" CAMERA "lights: {}", "3:9: error: expected a list for lights, got a map\n"},
        {"psd: 1\n" CAMERA "lights:\n  - spotlight: {location: [0, 0, 0], point_at: [0, 0, 0], "
         "intensity: 1, radius: 50}\n  - point: {intensity: -1}\n",
         "4:48: error: point_at is the spotlight's location; it must be another point\n"
         "4:81: error: radius 50 is larger than falloff 45 (the default) in spotlight\n"
         "5:5: error: missing key 'location' in point\n"
         "5:24: error: intensity in point: expected [r, g, b] or grey, each number >= 0, got "
         "'-1'\n"}};
    EXPECT_ALL(cases);
    struct scene_description d;
    char messages[LONGEST_OUTPUT];
    const char *dark = "psd: 1\n" CAMERA "lights: []";
    assert_int_equal(parse(dark, strlen(dark), &d, messages), PS_OK);
    assert_string_equal(messages, "3:1: warning: the scene has no lights\n");
    scene_description_release(&d);
}

static void test_objects(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "objects:\n  - blob: {}\n  - box:\n    material: white",
         "6:5: error: unknown object kind 'blob'; known are quad, box, triangles, sphere, "
         "cylinder, "
         "cone, disc, plane, torus, height_field, mesh, group, instance\n"
         "8:5: error: key 'material' stands beside 'box'; indent it to put it inside\n"},
        {HEAD "objects:\n  - box: {corners: [[0, 0, 0]], material: whit}\n",
         "6:20: error: corners in box: expected a list of 2 [x, y, z], got 1\n"
         "6:43: error: undefined material 'whit'; did you mean 'white'?\n"},
        {HEAD "objects:\n  - quad: {corners: 5, material: [white], scale: [1, 0, 1]}\n",
         "6:21: error: corners in quad: expected a list of 4 [x, y, z], got text\n"
         "6:34: error: material in quad: expected the name of a material, got a list\n"},
        {HEAD "objects:\n  - triangles: {material: white, vertices: [[0, 0, 0], [1, 0, 0], [0, 1, "
              "b]], triangles: [[0, 1, 3], [0, 1], [0, -1, 0.5]]}\n",
         "6:74: error: vertices in triangles: expected a number, got 'b'\n"
         "6:98: error: triangles in triangles: expected integer 0..2, got '3'\n"
         "6:102: error: triangles in triangles: expected [i, j, k], got another number of "
         "indices\n"
         "6:114: error: triangles in triangles: expected integer 0..2, got '-1'\n"
         "6:118: error: triangles in triangles: expected integer 0..2, got '0.5'\n"},
        {HEAD "objects:\n"
              "  - sphere: {center: [0, 0, 0], radius: 0, material: white, scale: big}\n"
              "  - sphere: {center: [0, 0, 0], radius: 1, material: white, scale: 0}\n",
         "6:41: error: radius in sphere: expected number > 0, got '0'\n"
         "6:68: error: scale in sphere: expected [x, y, z] or one number, got 'big'\n"
         "7:68: error: a factor of scale is 0\n"}};
    EXPECT_ALL(cases);
}

static void test_strategy_errors(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "render: {injection: {a: {}, b: {}}, filter: [x], denoiser: , estimator: {splat: 5}}",
         "5:21: error: injection in render: expected a plugin's name or {NAME: {PARAMETER: "
         "VALUE}}, got another map\n"
         "5:45: error: filter in render: expected a plugin's name or {NAME: {PARAMETER: "
         "VALUE}}, got a list\n"
         "5:60: error: denoiser in render: expected a plugin's name or {NAME: {PARAMETER: "
         "VALUE}}, got nothing\n"
         "5:81: error: expected a map for splat, got text\n"},
        {HEAD "render: {injection: {photon: {count: {}, size: [1, [2]]}}, injektion: x}",
         "5:38: error: count in photon: expected a number, a word or a list of them, got a map\n"
         "5:52: error: size in photon: expected a number or a word, got a list\n"
         "5:60: error: unknown key 'injektion' in render; did you mean 'injection'?\n"}};
    EXPECT_ALL(cases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_arithmetic_errors),
        cmocka_unit_test(test_keys),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_objects),
        cmocka_unit_test(test_strategy_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
