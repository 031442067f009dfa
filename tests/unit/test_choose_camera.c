/* test_choose_camera.c: --camera on a description with several of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <string.h>

#include "session/scene_options.h"

static void expect_order(const char *wanted, const char *expected)
{
    char names[4][8] = {"front", "left", "top", "back"}, order[64] = "";
    struct camera_description cameras[4] = {{.name = names[0], .angle = 0},
                                            {.name = names[1], .angle = 1},
                                            {.name = names[2], .angle = 2},
                                            {.name = names[3], .angle = 3}};
    struct scene_description description = {.cameras = cameras, .camera_count = 4};
    char name[8] = "";
    if (wanted)
        strcpy(name, wanted);
    const struct scene_options options = {.camera = wanted ? name : NULL};
    assert_int_equal(scene_options_choose_camera(&options, &description, NULL), PS_OK);
    for (int i = 0; i < 4; i++) {
        snprintf(order + strlen(order), sizeof order - strlen(order), " %s", cameras[i].name);
        assert_string_equal(cameras[i].name, names[(int)cameras[i].angle]);
    }
    assert_string_equal(order, expected);
}

static void test_the_chosen_camera_is_first(void **state)
{
    (void)state;
    expect_order(NULL, " front left top back");
    expect_order("front", " front left top back");
    expect_order("top", " top front left back");
    expect_order("back", " back front left top");
}

static void test_unknown_camera(void **state)
{
    (void)state;
    char name[] = "front";
    struct camera_description camera = {.name = name};
    struct scene_description description = {.cameras = &camera, .camera_count = 1};
    char wanted[] = "fornt";
    const struct scene_options options = {.camera = wanted};
    struct diagnostics *sink = diagnostics_create();
    assert_non_null(sink);
    assert_int_equal(scene_options_choose_camera(&options, &description, sink), PS_ERROR_INVALID);
    assert_int_equal(diagnostics_error_count(sink), 1);
    diagnostics_destroy(sink);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_chosen_camera_is_first),
        cmocka_unit_test(test_unknown_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
