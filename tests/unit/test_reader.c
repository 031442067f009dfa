/* test_reader.c: what the steps from tree to scene description share. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "parser/sections/reader.h"
#include <stdlib.h>

static void expect_path(const char *file, const char *text, const char *expected)
{
    struct reader reader = {.file = "main/scene.psd"};
    const struct node node = {.kind = NODE_SCALAR, .file = file, .text = text};
    char *path = reader_path(&reader, &node, text);
    assert_non_null(path);
    assert_string_equal(path, expected);
    assert_false(reader.out_of_memory);
    free(path);
}

static void test_paths_start_where_they_were_written(void **state)
{
    (void)state;
    expect_path("scene.psd", "wood.png", "wood.png");
    expect_path("lib/wood.psd", "wood.png", "lib/wood.png");
    expect_path("lib/wood.psd", "../wood.png", "lib/../wood.png");
    expect_path("/lib/wood.psd", "a/wood.png", "/lib/a/wood.png");
    expect_path("lib/wood.psd", "/wood.png", "/wood.png");
    expect_path("<stdin>", "wood.png", "wood.png");
    expect_path("--param", "wood.png", "wood.png");
    expect_path(NULL, "wood.png", "wood.png");
}

static void test_origins_are_of_the_nodes_file(void **state)
{
    (void)state;
    const struct reader reader = {.file = "scene.psd"};
    const struct node written = {.mark = {3, 4, 1}, .file = "lib/wood.psd"}, made = {.file = NULL};
    struct origin origin = reader_origin(&reader, &written);
    assert_string_equal(origin.file, "lib/wood.psd");
    assert_int_equal(origin.line, 3);
    assert_int_equal(origin.column, 4);
    assert_string_equal(reader_origin(&reader, &made).file, "scene.psd");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_paths_start_where_they_were_written),
        cmocka_unit_test(test_origins_are_of_the_nodes_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
