/* test_parser_lights.c: lights of scenes, right and wrong. */
#include "parser_fixture.h"

static void assert_vector(ps_vec3 v, double x, double y, double z)
{
    assert_true(v.x == (float)x && v.y == (float)y && v.z == (float)z);
}

static void test_points(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        "psd: 1\n" CAMERA "lights:\n"
        "  - point: {location: [1, 2, 3], intensity: 7}\n"
        "  - point: {location: [1, 2, 3], power: [1, 2, 3]}\n"
        "  - spotlight: {location: [0, 5, 0], point_at: [0, 0, 0], power: 6, tightness: 10}\n"
        "  - spotlight: {location: [0, 5, 0], point_at: [0, 0, 0], intensity: 5, falloff: 30}\n");
    assert_int_equal(d.light_count, 4);
    assert_true(d.lights[0].unit == UNIT_INTENSITY && d.lights[0].amount.g == 7);
    assert_true(d.lights[1].unit == UNIT_POWER && d.lights[1].amount.b == 3);
    assert_true(d.lights[2].unit == UNIT_POWER && d.lights[2].tightness == 10);
    assert_true(d.lights[3].unit == UNIT_INTENSITY && d.lights[3].falloff == 30);
    assert_true(d.lights[3].tightness == 0 && d.lights[3].texture == NO_INDEX);
    scene_description_release(&d);
}

static void test_suns_and_skies(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good("psd: 1\n" CAMERA "lights:\n"
                   "  - sun: {direction: [0, -2, 0], irradiance: [1000, 900, 800]}\n"
                   "  - sun: {direction: [0, 0, 1], radiance: 2e7, angle: 1}\n"
                   "  - sky: {radiance: [1, 2, 3], visible: no}\n"
                   "  - sky: {file: dir/sky.exr, rotate: 90}\n"
                   "  - sky: {file: dir/sky.exr, radiance: 0.5}\n");
    assert_int_equal(d.lights[0].kind, LIGHT_SUN);
    assert_vector(d.lights[0].direction, 0, -1, 0);
    assert_true(d.lights[0].unit == UNIT_IRRADIANCE && d.lights[0].amount.g == 900);
    assert_true(d.lights[0].angle == 0.53);
    assert_true(d.lights[1].unit == UNIT_RADIANCE && d.lights[1].angle == 1);
    assert_int_equal(d.lights[2].kind, LIGHT_SKY);
    assert_true(d.lights[2].amount.b == 3 && !d.lights[2].visible);
    assert_true(d.lights[2].texture == NO_INDEX && d.lights[2].unit == UNIT_RADIANCE);
    assert_true(d.lights[3].amount.r == 1 && d.lights[3].rotate == 90 && d.lights[3].visible);
    assert_string_equal(d.textures[d.lights[3].texture].path, "dir/sky.exr");
    assert_true(d.lights[4].amount.r == 0.5F && d.lights[4].unit == UNIT_RADIANCE);
    assert_int_equal(d.texture_count, 1);
    scene_description_release(&d);
}

static void test_areas(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good("psd: 1\n" CAMERA "lights:\n"
                   "  - rectangle: {corners: [[0, 2, 0], [4, 2, 0], [4, 2, 6]], power: 5}\n"
                   "  - rectangle: {corners: [[0, 2, 0], [4, 2, 0], [4, 2, 6], [0, 2, 6]],\n"
                   "                radiance: 3, both_sides: yes, visible: no}\n"
                   "  - disc: {location: [0, 1, 0], direction: [0, -3, 0], radius: 0.5, power: 2}\n"
                   "  - sphere: {location: [0, 1, 2], radius: 0.25, radiance: 9}\n");
    for (int i = 0; i < 2; i++) {
        assert_int_equal(d.lights[i].kind, LIGHT_RECTANGLE);
        assert_vector(d.lights[i].location, 2, 2, 3);
        assert_vector(d.lights[i].half_edges[0], 2, 0, 0);
        assert_vector(d.lights[i].half_edges[1], 0, 0, 3);
    }
    assert_true(d.lights[0].unit == UNIT_POWER && d.lights[0].visible && !d.lights[0].both_sides);
    assert_true(d.lights[1].unit == UNIT_RADIANCE && !d.lights[1].visible);
    assert_true(d.lights[1].both_sides && d.lights[1].amount.r == 3);
    assert_int_equal(d.lights[2].kind, LIGHT_DISC);
    assert_vector(d.lights[2].direction, 0, -1, 0);
    assert_true(d.lights[2].radius == 0.5 && d.lights[2].unit == UNIT_POWER);
    assert_int_equal(d.lights[3].kind, LIGHT_SPHERE);
    assert_true(d.lights[3].radius == 0.25 && d.lights[3].amount.g == 9);
    scene_description_release(&d);
}

/* A material that shines is light enough. */
static void test_emission_is_light(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good("psd: 1\n" CAMERA "materials: {lamp: {diffuse: 0, emission: 1}}\n");
    scene_description_release(&d);
}

#define START "psd: 1\n" CAMERA "lights:\n"

static void test_units(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {START "  - point: {location: [0, 0, 0]}\n"
               "  - point: {location: [0, 0, 0], intensity: 1, power: 2}\n"
               "  - point: {location: [0, 0, 0], radiance: 1}\n"
               "  - sun: {direction: [0, 1, 0], power: 1}\n"
               "  - sky: {}\n"
               "  - sky: {radiance: -1}\n",
         "4:5: error: point needs one of intensity, power\n"
         "5:55: error: point has both intensity and power; give one of them\n"
         "6:5: error: point needs one of intensity, power\n"
         "6:34: error: unknown key 'radiance' in point\n"
         "7:5: error: sun needs one of irradiance, radiance\n"
         "7:33: error: unknown key 'power' in sun\n"
         "8:5: error: sky needs one of radiance, file\n"
         "9:21: error: radiance in sky: expected [r, g, b] or grey, each number >= 0, got '-1'\n"},
        {START "  - sun: {direction: [0, 1, 0], radiance: 1, angle: 0}\n"
               "  - sun: {direction: [0, 0, 0], irradiance: 1}\n",
         "4:43: error: a sun of angle 0 is a point, which has no radiance; give irradiance\n"
         "5:22: error: the length of direction is 0\n"}};
    EXPECT_ALL(cases);
}

static void test_shapes(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {START "  - rectangle: {corners: [[0, 0, 0], [1, 0, 0]], power: 1}\n"
               "  - rectangle: {corners: [[0, 0, 0], [1, 0, 0], [2, 0, 0]], power: 1}\n"
               "  - rectangle: {corners: [[0, 0, 0], [1, 0, 0], [2, 1, 0]], power: 1}\n"
               "  - rectangle: {corners: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 2, 0]], power: 1}\n"
               "  - disc: {location: [0, 0, 0], direction: [0, 0, 0], radius: 0, power: 1}\n"
               "  - disc: {location: [0, 0, 0], direction: [0, 0, 0], radius: 1, power: 1}\n",
         "4:26: error: corners in rectangle: expected a list of 3 to 4 [x, y, z], got 2\n"
         "5:26: error: corners in rectangle: the corners are on one line\n"
         "6:26: error: corners in rectangle: the corners have no right angle\n"
         "7:26: error: corners in rectangle: the fourth corner is not where a rectangle has it\n"
         "8:63: error: radius in disc: expected number > 0, got '0'\n"
         "9:44: error: the length of direction is 0\n"},
        {START
         "  - spotlight: {location: [0, 0, 0], point_at: [0, 1, 0], intensity: 1, falloff: 9, "
         "tightness: -1}\n"
         "  - spotlight: {location: [0, 0, 0], point_at: [0, 1, 0], intensity: 1, falloff: 9}\n",
         "4:96: error: tightness in spotlight: expected number >= 0, got '-1'\n"
         "5:82: error: radius 30 (the default) is larger than falloff 9 in spotlight\n"}};
    EXPECT_ALL(cases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points), cmocka_unit_test(test_suns_and_skies),
        cmocka_unit_test(test_areas),  cmocka_unit_test(test_emission_is_light),
        cmocka_unit_test(test_units),  cmocka_unit_test(test_shapes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
