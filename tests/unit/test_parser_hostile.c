/* test_parser_hostile.c: texts that are no YAML, no text, or an attack. */
#include "parser_fixture.h"

#include <stdlib.h>

/* Fills a text of `count` copies of a piece. */
static char *repeat(const char *piece, size_t count)
{
    size_t length = strlen(piece);
    char *text = malloc(length * count + 1);
    assert_non_null(text);
    for (size_t i = 0; i < count; i++)
        memcpy(text + i * length, piece, length);
    text[length * count] = '\0';
    return text;
}

static void expect_repeated(const char *piece, size_t count, const char *expected)
{
    char *text = repeat(piece, count);
    expect_bytes(text, strlen(text), expected);
    free(text);
}

static void test_yaml(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "image: *i", "5:8: error: undefined alias '*i'\n"},
        {HEAD "image: &i {width: *i}", "5:19: error: alias '*i' stands inside of what it names\n"},
        {HEAD "---\na: 1", "5:1: error: a second document starts here; a scene is one document\n"},
        {HEAD "image: !foo {}", "5:8: error: tag '!foo' is not allowed here\n"},
        {HEAD "image: !!seq {}", "5:8: error: tag '!!seq' is not allowed here\n"},
        {HEAD "image: {width: !!binary 5}", "5:16: error: tag '!!binary' is not allowed here\n"},
        {HEAD "image: {width: \"1\\0\"}", "5:16: error: a NUL character is not allowed\n"},
        {HEAD "image: {width: 1\n",
         "6:1: error: did not find expected ',' or '}', while parsing a flow mapping that begins "
         "at line 5, column 8\n"},
        {HEAD "image:\n\twidth: 1",
         "6:1: error: found character that cannot start any token, while scanning for the next "
         "token that begins at line 6, column 1\n"},
        {HEAD "a\xc3\xa9: \xff", "5:5: error: byte 0xff is not UTF-8; save the scene as UTF-8\n"},
        {"psd: 1\r\n\r\xe2\x80\xa8 \xc0\x80",
         "4:2: error: byte 0xc0 is not UTF-8; save the scene as UTF-8\n"},
        {HEAD "a: \x07", "5:4: error: character U+0007 is not allowed\n"}};
    EXPECT_ALL(cases);
    expect_bytes("psd:\0 1", 7, "1:5: error: character U+0000 is not allowed\n");
    expect_bytes("\xff\xfep\0s\0", 6,
                 "1:1: error: byte 0xff is not UTF-8; save the scene as UTF-8\n");
}

static void test_caps(void **state)
{
    (void)state;
    /* libyaml alone takes time by the square of the depth: it would not end within the test's
     * limit. */
    expect_repeated("[", 4000000, "1:65: error: nested deeper than 64 levels\n");
    expect_repeated("{a: ", 1000000, "1:257: error: nested deeper than 64 levels\n");
    expect_repeated("- ", 1000000, "1:129: error: nested deeper than 64 levels\n");
    expect_repeated("%TAG !a! b\n", 80000, "17:1: error: more than 16 directives ('%')\n");
    const char *bomb = "a: &a [x, x, x, x, x, x, x, x, x, x]\n"
                       "b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]\n"
                       "c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]\n"
                       "d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]\n"
                       "e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]\n"
                       "f: &f [*e, *e, *e, *e, *e, *e, *e, *e, *e, *e]\n";
    expect_bytes(bomb, strlen(bomb),
                 "4:44: error: aliases expand this text to more than 11900 values\n");
    const char *tower = "a: &a [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]\n"
                        "b: [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[*a]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]\n";
    expect_bytes(tower, strlen(tower), "2:36: error: nested deeper than 64 levels\n");
    expect_repeated("- 1\n", 4000000, "4000000:3: error: more than 4000000 values in one scene\n");
}

static void test_files(void **state)
{
    (void)state;
    struct diagnostics *sink = diagnostics_create();
    struct scene_description description;
    char printed[LONGEST_OUTPUT];
    assert_non_null(sink);
    assert_int_equal(psd_read_file("/nonexistent.psd", sink, &description), PS_ERROR_IO);
    print_all(sink, printed);
    assert_string_equal(printed,
                        "/nonexistent.psd: error: cannot open: No such file or directory\n");
    diagnostics_destroy(sink);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_yaml),
        cmocka_unit_test(test_caps),
        cmocka_unit_test(test_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
