/* test_json.c: strings of JSON without their escapes, and JSON in one line. What else is read is in
 * test_mesh_hostile.c. */
#include "base/json_reader.h"
#include "base/json_writer.h"

#include "scratch.h"

static char *unescape(const char *text)
{
    const struct json_text string = {text, strlen(text)};
    return json_unescape(&string);
}

static void expect(const char *text, const char *expected)
{
    char *found = unescape(text);
    assert_non_null(found);
    assert_string_equal(found, expected);
    free(found);
}

static void expect_none(const char *text)
{
    char *found = unescape(text);
    if (found)
        fail_msg("'%s' is '%s'", text, found);
}

static void test_escapes(void **state)
{
    (void)state;
    expect("", "");
    expect("a b", "a b");
    expect("\\\"\\\\\\/\\b\\f\\n\\r\\t", "\"\\/\b\f\n\r\t");
    expect("\\u0041\\u00e9\\u20AC\\ud83d\\ude00.", "A\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80.");
    expect("\xc3\xa9", "\xc3\xa9");
}

static void test_wrong_escapes(void **state)
{
    static const char *const texts[] = {
        "\\",      "\\x",     "\\u",        "\\u12",          "\\u12g4",        "\\u0000",
        "\\ud83d", "\\ude00", "\\ud83d\\n", "\\ud83d\\u0041", "\\ud83d\\ud83d", "\\ud83dude00"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        expect_none(texts[i]);
}

static void write_sample(bool compact, char **text)
{
    size_t length;
    struct json_writer writer = {.stream = open_memstream(text, &length), .compact = compact};
    assert_non_null(writer.stream);
    json_writer_open(&writer, '{');
    json_writer_text_of(&writer, "a", "x\n\"");
    json_writer_open_of(&writer, "b", '[');
    json_writer_number(&writer, 0.5);
    json_writer_raw(&writer, "null");
    json_writer_close(&writer, '[');
    json_writer_open_of(&writer, "c", '{');
    json_writer_close(&writer, '{');
    json_writer_close(&writer, '{');
    assert_int_equal(fclose(writer.stream), 0);
}

static void test_in_one_line(void **state)
{
    char *text = NULL;
    (void)state;
    write_sample(true, &text);
    assert_string_equal(text, "{\"a\":\"x\\u000a\\\"\",\"b\":[0.5,null],\"c\":{}}");
    free(text);
    write_sample(false, &text);
    assert_string_equal(text,
                        "{\n  \"a\": \"x\\u000a\\\"\",\n  \"b\": [\n    0.5,\n    null\n  ],\n"
                        "  \"c\": {}\n}");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_escapes),
        cmocka_unit_test(test_wrong_escapes),
        cmocka_unit_test(test_in_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
