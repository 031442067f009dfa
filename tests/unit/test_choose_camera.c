/* test_choose_camera.c: --camera on a description with several of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The program's own file, which no library holds, and what it needs of the others; cmocka has
 * another function of that name. */
#define print_error print_program_error
#include "cli/scene_options.c" // NOLINT(bugprone-suspicious-include)

void print_error(const char *message)
{
    fputs(message, stderr);
    abort();
}
#undef print_error

static void expect_order(const char *wanted, const char *expected)
{
    char names[4][8] = {"front", "left", "top", "back"}, order[64] = "";
    struct camera_description cameras[4] = {{.name = names[0], .angle = 0},
                                            {.name = names[1], .angle = 1},
                                            {.name = names[2], .angle = 2},
                                            {.name = names[3], .angle = 3}};
    struct scene_description description = {.cameras = cameras, .camera_count = 4};
    const struct scene_options options = {.camera = wanted};
    assert_true(scene_options_choose_camera(&options, &description));
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
    const struct scene_options options = {.camera = "fornt"};
    assert_false(scene_options_choose_camera(&options, &description));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_chosen_camera_is_first),
        cmocka_unit_test(test_unknown_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
