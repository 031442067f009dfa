/* test_parser_materials.c: cameras, materials, pigments and textures of scenes, right and wrong. */
#include "parser_fixture.h"

#include <math.h>

static void test_cameras(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        "psd: 1\n" CAMERA LIGHTS "cameras:\n"
        "  top: {location: [0, 9, 0], look_at: [0, 0, 0], up: [0, 0, 1], width: 4,\n"
        "        projection: orthographic}\n"
        "  lens: {location: [0, 0, 9], look_at: [0, 0, 0], angle: 40, aperture: 0.1, focus: 3}\n"
        "image: {filter: gaussian}\n");
    assert_int_equal(d.camera_count, 3);
    assert_string_equal(d.cameras[0].name, "camera");
    assert_int_equal(d.cameras[0].kind, CAMERA_PERSPECTIVE);
    assert_true(d.cameras[0].angle == 67.38 && d.cameras[0].aperture == 0);
    assert_string_equal(d.cameras[1].name, "top");
    assert_int_equal(d.cameras[1].kind, CAMERA_ORTHOGRAPHIC);
    assert_true(d.cameras[1].width == 4 && d.cameras[1].angle == 0);
    assert_int_equal(d.cameras[1].origin.line, 5);
    assert_true(d.cameras[2].aperture == 0.1 && d.cameras[2].focus == 3);
    assert_int_equal(d.image.filter, PIXEL_GAUSSIAN);
    scene_description_release(&d);
    d = parse_good("psd: 1\n" LIGHTS "cameras: {a: {location: [0, 0, 9], look_at: [0, 0, 0]}}\n");
    assert_int_equal(d.camera_count, 1);
    assert_int_equal(d.image.filter, PIXEL_BOX);
    scene_description_release(&d);
}

static void test_kinds(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good("psd: 1\n" CAMERA LIGHTS "materials:\n"
                   "  shiny: {mirror: 0.9}\n"
                   "  gold: {metal: {color: [1, 0.75, 0.25], roughness: 0.25}}\n"
                   "  red: {glossy: {diffuse: [0.5, 0, 0]}}\n"
                   "  glass: {dielectric: {ior: 1.25, absorption: [1, 2, 3]}}\n"
                   "  lamp: {diffuse: 0, emission: [18, 15, 8], emission_both: yes}\n"
                   "  plain: {diffuse: 0.5}\n");
    const struct material_description *m = d.materials;
    assert_int_equal(d.material_count, 6);
    assert_int_equal(m[0].kind, MATERIAL_MIRROR);
    assert_true(m[0].color.colors[0].g == 0.9F);
    assert_int_equal(m[1].kind, MATERIAL_METAL);
    assert_true(m[1].color.colors[0].g == 0.75F && m[1].roughness.colors[0].b == 0.25F);
    assert_int_equal(m[2].kind, MATERIAL_GLOSSY);
    assert_true(m[2].specular.colors[0].r == 0.04F && m[2].roughness.colors[0].r == 0.2F);
    assert_true(m[2].color.colors[0].r == 0.5F);
    assert_int_equal(m[3].kind, MATERIAL_DIELECTRIC);
    assert_true(m[3].ior == 1.25 && m[3].absorption.b == 3 && m[3].color.colors[0].r == 1);
    assert_int_equal(m[4].kind, MATERIAL_DIFFUSE);
    assert_true(m[4].emission.colors[0].b == 8 && m[4].emission_both);
    assert_true(m[5].emission.colors[0].b == 0 && !m[5].emission_both);
    for (size_t i = 0; i < d.material_count; i++) {
        assert_true(m[i].opacity.colors[0].r == 1 && m[i].bump.colors[0].r == 0);
        assert_true(m[i].normal_map.texture == NO_INDEX && m[i].opacity.texture == NO_INDEX);
        assert_int_equal(m[i].origin.line, 5 + (int)i);
    }
    scene_description_release(&d);
}

static void test_patterns(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        "psd: 1\n" CAMERA LIGHTS "materials:\n"
        "  floor: {diffuse: {checker: {colors: [[1, 0.5, 1], 0], scale: 10}}}\n"
        "  air: {diffuse: {gradient: {colors: [1, 0], axis: [1, 0, 0], turbulence: 0.25}}}\n"
        "  stone: {diffuse: {noise: {colors: [0.5, 1], translate: [1, 2, 3]}},\n"
        "          bump: {noise: {colors: [-1, 2], octaves: 6}}}\n");
    const struct pigment_description *p = &d.materials[0].color;
    assert_int_equal(p->kind, PIGMENT_CHECKER);
    assert_true(p->colors[0].g == 0.5F && p->colors[1].r == 0 && p->placement.y.y == 10);
    p = &d.materials[1].color;
    assert_int_equal(p->kind, PIGMENT_GRADIENT);
    assert_true(p->axis.x == 1 && p->axis.y == 0 && p->turbulence == 0.25);
    p = &d.materials[2].color;
    assert_int_equal(p->kind, PIGMENT_NOISE);
    assert_true(p->octaves == 4 && p->placement.translation.z == 3 && p->placement.x.x == 1);
    p = &d.materials[2].bump;
    assert_true(p->octaves == 6 && p->colors[0].r == -1 && p->colors[1].r == 2);
    scene_description_release(&d);
}

static void test_pictures(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        "psd: 1\n" CAMERA LIGHTS "materials:\n"
        "  wood: {diffuse: {image: {file: a/wood.png, repeat: [2, 3], offset: 0.5, color: 0.25}}}\n"
        "  same: {diffuse: {image: {file: a/wood.png}}}\n"
        "  leaf: {diffuse: {image: {file: a/wood.png, wrap: mirror, interpolate: nearest}},\n"
        "         opacity: {image: {file: /b/leaf.png, channel: a}},\n"
        "         normal_map: {file: n.png, wrap: clamp}}\n");
    const struct material_description *m = d.materials;
    const struct pigment_description *p = &m[0].color;
    assert_int_equal(p->kind, PIGMENT_IMAGE);
    assert_true(p->scale_u == 2 && p->scale_v == 3 && p->offset_u == 0.5 && p->offset_v == 0.5);
    assert_true(p->colors[0].r == 0.25F && p->channel == CHANNEL_RGB);
    assert_int_equal(d.texture_count, 4);
    assert_string_equal(d.textures[p->texture].path, "a/wood.png");
    assert_int_equal(d.textures[p->texture].origin.line, 5);
    assert_int_equal(d.textures[p->texture].encoding, ENCODING_AUTO);
    assert_int_equal(m[1].color.texture, p->texture);
    assert_true(m[1].color.scale_u == 1 && m[1].color.offset_v == 0);
    const struct texture_description *t = &d.textures[m[2].color.texture];
    assert_true(t->wrap_u == WRAP_MIRROR && t->wrap_v == WRAP_MIRROR && t->nearest &&
                !d.textures[p->texture].nearest);
    assert_int_equal(m[2].opacity.channel, CHANNEL_A);
    assert_int_equal(d.textures[m[2].opacity.texture].encoding, ENCODING_LINEAR);
    assert_string_equal(d.textures[m[2].opacity.texture].path, "/b/leaf.png");
    assert_int_equal(d.textures[m[2].normal_map.texture].encoding, ENCODING_LINEAR);
    assert_int_equal(d.textures[m[2].normal_map.texture].wrap_u, WRAP_CLAMP);
    scene_description_release(&d);
}

/* Components come first, whatever the file's order. */
static void test_mixes(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        "psd: 1\n" CAMERA LIGHTS "materials:\n"
        "  outer: {mix: [{material: inner, weight: 0.25}, {material: white, weight: 0.75}]}\n"
        "  inner: {mix: [{material: black, weight: 0.5}]}\n"
        "  white: {diffuse: 1}\n"
        "  black: {diffuse: 0}\n"
        "objects:\n"
        "  - sphere: {center: [0, 0, 0], radius: 1, material: outer}\n");
    const struct material_description *m = d.materials;
    const struct material_description *outer = &m[d.objects[0].material];
    assert_string_equal(outer->name, "outer");
    assert_int_equal(outer->kind, MATERIAL_MIX);
    assert_int_equal(outer->component_count, 2);
    assert_string_equal(m[outer->components[0]].name, "inner");
    assert_string_equal(m[outer->components[1]].name, "white");
    assert_true(outer->weights[0] == 0.25 && outer->weights[1] == 0.75);
    for (size_t i = 0; i < d.material_count; i++)
        for (size_t j = 0; j < m[i].component_count; j++)
            assert_true(m[i].components[j] < i);
    scene_description_release(&d);
}

#define START "psd: 1\n" CAMERA LIGHTS "materials:\n"

static void test_layers(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good("psd: 1\n" CAMERA "lights: [sky: {file: a.exr, layer: view.sky}]\n"
                   "materials:\n"
                   "  a: {diffuse: {image: {file: a.exr, layer: albedo}}}\n"
                   "  b: {diffuse: {image: {file: a.exr}}, normal_map: {file: a.exr, layer: n}}\n"
                   "  c: {diffuse: {image: {file: a.exr, layer: albedo}}}\n");
    assert_int_equal(d.texture_count, 4);
    assert_string_equal(d.textures[d.materials[0].color.texture].layer, "albedo");
    assert_null(d.textures[d.materials[1].color.texture].layer);
    assert_string_equal(d.textures[d.materials[1].normal_map.texture].layer, "n");
    assert_int_equal(d.materials[2].color.texture, d.materials[0].color.texture);
    assert_string_equal(d.textures[d.lights[0].texture].layer, "view.sky");
    scene_description_release(&d);
}

static void test_wrong_kinds(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {START "  a: {}\n  b: {diffuse: 1, metal: {color: 1}, mirror: 1}\n  c: {emission: 1}\n",
         "5:3: error: material needs one of diffuse, mirror, metal, glossy, dielectric, mix\n"
         "6:26: error: material has both diffuse and metal; give one of them\n"
         "6:46: error: material has both diffuse and mirror; give one of them\n"
         "7:3: error: material needs one of diffuse, mirror, metal, glossy, dielectric, mix\n"},
        {START "  a: {metal: {rougness: 2}}\n  b: {dielectric: 5}\n  c: {glossy: {roughness: 2}}\n",
         "5:7: error: missing key 'color' in metal\n"
         "5:15: error: unknown key 'rougness' in metal; did you mean 'roughness'?\n"
         "6:19: error: expected a map for dielectric, got text\n"
         "7:7: error: missing key 'diffuse' in glossy\n"
         "7:27: error: roughness in glossy: expected number 0..1, got '2'\n"},
        {START "  a: {diffuse: 1, emission: -1, opacity: [1, 1, 1], emission_both: maybe}\n",
         "5:29: error: emission in material: expected [r, g, b] or grey, each number >= 0, got "
         "'-1'\n"
         "5:42: error: opacity in material: expected number 0..1, got a list\n"
         "5:68: error: emission_both in material: expected yes | no, got 'maybe'\n"},
        {START "  a: {diffuse: 1, normal_map: {fil: n.png}}\n",
         "5:19: error: missing key 'file' in normal_map\n"
         "5:32: error: unknown key 'fil' in normal_map; did you mean 'file'?\n"}};
    EXPECT_ALL(cases);
}

static void test_wrong_patterns(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {START "  a: {diffuse: {chequer: {}}}\n  b: {diffuse: }\n  c: {diffuse: {}}\n",
         "5:17: error: unknown pigment kind 'chequer'; did you mean 'checker'?\n"
         "6:16: error: diffuse in material: expected [r, g, b] or grey, each number 0..1, got "
         "nothing\n"
         "7:16: error: expected a map with one key in diffuse, got an empty map\n"},
        {START "  a: {diffuse: {checker: {colors: [1]}}}\n  b: {diffuse: {noise: {}}}\n",
         "5:35: error: colors in checker: expected a list of 2 [r, g, b] or grey, got 1\n"
         "6:17: error: missing key 'colors' in noise\n"},
        {START "  a: {diffuse: {checker: {colors: [0, 2]}}}\n"
               "  b: {diffuse: {image: {file: a.png, color: [0, 0, 1.5]}}}\n"
               "  c: {diffuse: {gradient: {colors: [0, 1], axis: [0, 0, 0], scale: 0}}}\n"
               "  d: {diffuse: {gradient: {colors: [0, 1], scale: 0}}}\n",
         "5:35: error: colors in checker: diffuse in material takes [r, g, b] or grey, each number "
         "0..1\n"
         "6:45: error: color in image: diffuse in material takes [r, g, b] or grey, each number "
         "0..1\n"
         "7:50: error: axis in gradient: its length is 0\n"
         "8:51: error: a factor of scale is 0\n"},
        {START "  a: {diffuse: {image: {file: [a], wrap: reepat}}}\n"
               "  b: {diffuse: {image: {file: a.png, repeat: [1, 2, 3], offset: x}}}\n",
         "5:31: error: file in image: expected the path of a file, got a list\n"
         "5:42: error: wrap in image: expected repeat | clamp | mirror, got 'reepat'\n"
         "6:46: error: repeat in image: expected 2 numbers, got 3\n"
         "6:65: error: offset in image: expected a number, got 'x'\n"}};
    EXPECT_ALL(cases);
}

static void test_wrong_mixes(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {START "  a: {mix: [{material: b, weight: 1}]}\n  b: {mix: [{material: a, weight: 1}]}\n",
         "5:3: error: material 'a' is mixed from itself\n"},
        {START "  a: {mix: [{material: a, weight: 1}]}\n",
         "5:3: error: material 'a' is mixed from itself\n"},
        {START "  a: {mix: []}\n  b: {mix: 5}\n  w: {diffuse: 1}\n"
               "  c: {mix: [{material: w, weight: 0.75}, {material: w, weight: 0.5}]}\n"
               "  d: {mix: [{material: xyz, weight: 0}, {weight: 1}]}\n",
         "5:7: error: mix needs at least one material\n"
         "6:12: error: expected a list for mix, got text\n"
         "8:7: error: the weights of mix sum to 1.25, which is more than 1\n"
         "9:24: error: undefined material 'xyz'\n"
         "9:37: error: weight in mix: expected number 0..1 (0 excluded), got '0'\n"
         "9:41: error: missing key 'material' in mix\n"}};
    EXPECT_ALL(cases);
}

/* `count` mixes of one another, from the outermost to a plain material or the other way round. */
static void expect_deep(bool outermost_first, size_t count, const char *expected)
{
    char text[8192] = START;
    for (size_t i = 0; i <= count; i++) {
        size_t inside = outermost_first ? count - i : i; /* levels of mixes in this one */
        size_t used = strlen(text);
        if (inside > 0)
            snprintf(text + used, sizeof text - used,
                     "  m%zu: {mix: [{material: m%zu, weight: 1}]}\n", inside, inside - 1);
        else
            snprintf(text + used, sizeof text - used, "  m0: {diffuse: 1}\n");
    }
    if (expected) {
        expect_bytes(text, strlen(text), expected);
        return;
    }
    struct scene_description d = parse_good(text);
    scene_description_release(&d);
}

static void test_deep_mixes(void **state)
{
    (void)state;
    expect_deep(true, 16, NULL);
    expect_deep(false, 16, NULL);
    expect_deep(true, 17, "22:3: error: material 'm0' is nested too deeply in mixes\n");
    expect_deep(false, 17, "22:3: error: material 'm17' nests mixes too deeply\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cameras),     cmocka_unit_test(test_kinds),
        cmocka_unit_test(test_patterns),    cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_layers),      cmocka_unit_test(test_mixes),
        cmocka_unit_test(test_wrong_kinds), cmocka_unit_test(test_wrong_patterns),
        cmocka_unit_test(test_wrong_mixes), cmocka_unit_test(test_deep_mixes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
