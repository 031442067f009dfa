/* test_parser.c: what the scene parser accepts, and the tables of its language. */
#include "parser_fixture.h"

#include "parser/language/arithmetic.h"
#include "parser/schema/schema.h"
#include "settings/quality.h"
#include <math.h>

static void assert_vector(ps_vec3 v, double x, double y, double z)
{
    assert_true(v.x == (float)x && v.y == (float)y && v.z == (float)z);
}

static void test_whole_scene(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        "psd: 1\n"
        "camera: {location: [278, 273, -800], look_at: [278, 273, 0], vertical_angle: 37.5}\n"
        "image: {width: 1600, height: 900, exposure: -1}\n"
        "lights:\n"
        "  - spotlight: {location: [1, 548, 2], point_at: [1, 0, 2], radius: 50, falloff: 60,\n"
        "                intensity: [1e6, 2e6, 3e6]}\n"
        "  - point: {location: [1, 2, 3], intensity: 7}\n"
        "objects:\n"
        "  - box: {corners: [[0, 0, 0], [1, 2, 3]], rotate: [0, 17, 0], material: red}\n"
        "  - quad: {corners: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: white}\n"
        "  - triangles: {triangles: [[0, 1, 2], [2, 1, 3]], material: white, scale: 2,\n"
        "                vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [9, 8, 7]]}\n"
        "  - sphere: {center: [4, 5, 6], radius: 2, material: red, scale: [-2, 2, 2]}\n"
        "materials:\n"
        "  white: {diffuse: 0.75}\n"
        "  red: {diffuse: [0.5, 0.25, 0.125]}\n");
    assert_true(d.cameras[0].vertical_angle == 37.5 && d.cameras[0].angle == 0);
    assert_vector(d.cameras[0].location, 278, 273, -800);
    assert_vector(d.cameras[0].up, 0, 1, 0);
    assert_int_equal(d.image.width, 1600);
    assert_true(d.image.exposure == -1);
    assert_int_equal(d.light_count, 2);
    assert_int_equal(d.lights[0].kind, LIGHT_SPOT);
    assert_true(d.lights[0].radius == 50 && d.lights[0].amount.b == 3e6F);
    assert_int_equal(d.lights[0].origin.line, 5);
    assert_int_equal(d.lights[0].origin.column, 5);
    assert_string_equal(d.lights[0].origin.file, "t");
    assert_int_equal(d.lights[1].kind, LIGHT_POINT);
    assert_int_equal(d.object_count, 4);
    assert_int_equal(d.objects[0].kind, OBJECT_BOX);
    assert_string_equal(d.materials[d.objects[0].material].name, "red");
    assert_vector(d.objects[0].vertices[1], 1, 2, 3);
    assert_true(fabs(d.objects[0].placement.x.z + sin(17 * acos(-1) / 180)) < 1e-6);
    assert_vector(d.objects[0].placement.y, 0, 1, 0);
    assert_int_equal(d.objects[1].vertex_count, 4);
    assert_vector(d.objects[2].placement.z, 0, 0, 2);
    assert_int_equal(d.objects[2].triangle_count, 2);
    assert_int_equal(d.objects[2].triangles[1][2], 3);
    assert_vector(d.objects[3].center, 4, 5, 6);
    assert_true(d.materials[1].color.colors[0].g == 0.25F &&
                d.materials[0].color.colors[0].b == 0.75F);
    scene_description_release(&d);
}

static void test_defaults(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        "psd: 1\n" CAMERA "lights: [{spotlight: {location: [0, 0, 0], point_at: [0, 0, 1], "
        "intensity: 1}}]\nobjects:\n");
    assert_true(d.cameras[0].angle == 67.38 && d.cameras[0].vertical_angle == 0);
    assert_int_equal(d.image.width, 800);
    assert_int_equal(d.image.height, 450);
    assert_true(d.lights[0].radius == 30 && d.lights[0].falloff == 45);
    assert_int_equal(d.object_count, 0);
    assert_true(d.render.passes.choice == 0 && d.render.quality == QUALITY_NORMAL);
    assert_int_equal(d.render.seed, 0);
    assert_true(d.render.indirect_exposure == 1 && d.render.ambient.g == 0);
    for (size_t i = 0; i < PS_KINDS; i++)
        assert_null(d.render.strategies[i].name);
    scene_description_release(&d);
}

static void test_automatic_cameras(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good("psd: 1\ncamera: auto\n" LIGHTS
                   "cameras:\n  a: {location: auto, projection: orthographic, look_at: [1, 2, 3]}\n"
                   "  b: {location: [4, 5, 6]}\n  c: auto\n  d: {location: auto, angle: 20}\n");
    assert_int_equal(d.camera_count, 5);
    for (size_t i = 0; i < 5; i++) {
        assert_int_equal(d.cameras[i].finds_location, i != 2);
        assert_int_equal(d.cameras[i].finds_look_at, i != 1);
    }
    assert_true(d.cameras[0].angle == 0 && d.cameras[0].vertical_angle == 0);
    assert_vector(d.cameras[1].look_at, 1, 2, 3);
    assert_vector(d.cameras[2].location, 4, 5, 6);
    assert_true(d.cameras[2].angle == 67.38 && d.cameras[4].angle == 20);
    assert_string_equal(d.cameras[3].name, "c");
    scene_description_release(&d);
}

static void test_strategies(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        HEAD "render:\n  injection: {photon: {count: =25*1000, guide: yes, at: [1, =1+1, x]}}\n"
             "  filter: gaussian\n  denoiser: {bilateral: }\n  passes: 16\n  seed: =2^53\n");
    const struct strategy_choice *injection = &d.render.strategies[0];
    assert_string_equal(injection->name, "photon");
    assert_int_equal(injection->parameter_count, 3);
    assert_string_equal(injection->parameters[0].key, "count");
    assert_string_equal(injection->parameters[0].value, "25000");
    assert_int_equal(injection->parameters[0].key_origin.line, 6);
    assert_int_equal(injection->parameters[0].key_origin.column, 24);
    assert_int_equal(injection->parameters[0].value_origin.column, 31);
    assert_string_equal(injection->parameters[1].value, "yes");
    assert_string_equal(injection->parameters[2].value, "[1, 2, x]");
    assert_string_equal(d.render.strategies[3].name, "gaussian");
    assert_int_equal(d.render.strategies[3].parameter_count, 0);
    assert_string_equal(d.render.strategies[6].name, "bilateral");
    assert_true(d.render.passes.choice < 0 && d.render.passes.number == 16);
    assert_true(d.render.seed == INT64_C(9007199254740992));
    scene_description_release(&d);
}

static void test_anchors_and_merges(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good("psd: 1\n" CAMERA "lights:\n"
                   "  - spotlight: &a {location: &v [0, 5, 0], point_at: [0, 0, 0], intensity: 1}\n"
                   "  - spotlight: {<<: *a, falloff: 60, intensity: 2}\n"
                   "  - spotlight: &b {radius: 1, falloff: 2, point_at: [0, 0, 9], location: *v,\n"
                   "                   intensity: 5}\n"
                   "  - spotlight: {<<: [*b, *a], falloff: 50}\n"
                   "  - point: {location: &v [7, 0, 0], intensity: 1}\n"
                   "  - point: {location: *v, intensity: !!float 1}\n");
    assert_vector(d.lights[1].location, 0, 5, 0);
    assert_true(d.lights[1].amount.r == 2 && d.lights[1].falloff == 60);
    assert_vector(d.lights[3].point_at, 0, 0, 9);
    assert_true(d.lights[3].radius == 1 && d.lights[3].falloff == 50);
    assert_vector(d.lights[5].location, 7, 0, 0);
    scene_description_release(&d);
}

static void test_arithmetic_values(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
    } cases[] = {{"2*pi/3", 2 * 3.14159265358979323846 / 3},
                 {"-2^2", -4},
                 {"2^3^2", 512},
                 {"2^-1", 0.5},
                 {"1 - 2 - 3", -4},
                 {"8/4/2", 1},
                 {"(1+2)*(3)", 9},
                 {"min(1,2)+max(1,2)*10", 21},
                 {"abs(-3)+sqrt(16)", 7},
                 {"cos(0)+sin(0)+tan(0)", 1},
                 {"degrees(pi)", 180},
                 {"radians(180)", 3.14159265358979323846},
                 {"1e3+.5", 1000.5},
                 {"--1", 1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct error error;
        size_t position;
        double value = NAN;
        assert_int_equal(arithmetic_evaluate(cases[i].text, NULL, &value, &position, &error),
                         PS_OK);
        assert_true(fabs(value - cases[i].value) <= 1e-12 * fabs(cases[i].value));
    }
}

static bool has_family(const char *family)
{
    for (size_t i = 0; i < schema_section_count(); i++)
        if (strcmp(schema_section(i)->family, family) == 0)
            return true;
    return false;
}

static void test_schema(void **state)
{
    (void)state;
    size_t rows = 0;
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *section = schema_section(i);
        struct param_table table = schema_table(section);
        assert_ptr_equal(schema_find(section->family, section->name), section);
        assert_true(strlen(section->summary) > 0);
        for (size_t j = 0; j < section->row_count; j++, rows++) {
            const struct schema_row *row = &section->rows[j];
            char type[128] = "";
            schema_describe(row, type, sizeof type);
            assert_true(strlen(type) > 0 && strlen(row->param.help) > 0 && row->param.unit);
            assert_ptr_equal(param_find(&table, row->param.name), &row->param);
            assert_true(!row->family || has_family(row->family));
            assert_true(row->form < SCHEMA_MAP || row->form == SCHEMA_OTHER || row->family);
            assert_true(!row->shared || schema_only(row->shared));
        }
    }
    assert_true(rows > 200);
    assert_null(schema_find("lights", "box"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole_scene),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_automatic_cameras),
        cmocka_unit_test(test_strategies),
        cmocka_unit_test(test_anchors_and_merges),
        cmocka_unit_test(test_arithmetic_values),
        cmocka_unit_test(test_schema),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
