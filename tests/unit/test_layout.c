/* test_layout.c: how scenes are laid out, and that nothing but blanks and line breaks changes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "parser/format.h"
#include "support/run_tests.h"
#include <stdlib.h>
#include <string.h>

static char *format_or_null(const char *text)
{
    struct diagnostics *sink = diagnostics_create();
    char *formatted = NULL;
    size_t length = 0;
    assert_non_null(sink);
    if (psd_format_text("a.psd", text, strlen(text), sink, &formatted, &length) == PS_OK)
        assert_int_equal(strlen(formatted), length);
    else
        assert_true(diagnostics_error_count(sink) > 0);
    diagnostics_destroy(sink);
    return formatted;
}

/* The text becomes that one, which stays as it is. */
static void expect(const char *text, const char *expected)
{
    char *once = format_or_null(text);
    assert_non_null(once);
    assert_string_equal(once, expected);
    char *twice = format_or_null(once);
    assert_string_equal(twice, expected);
    free(once);
    free(twice);
}

static void test_gaps(void **state)
{
    (void)state;
    expect("a:   1\n", "a: 1\n");
    expect("a : 1\n\"b\"  :  'c'\n", "a: 1\n\"b\": 'c'\n");
    expect("a: { b :1 ,c:  [ 1,2 , 3,] }\n", "a: {b :1, c: [1, 2, 3,]}\n");
    expect("a: {\"b\":1,'c':[ ]}\n", "a: {\"b\": 1, 'c': []}\n");
    expect("a: &x   {b: 1}\nc:   *x\nd:  !!str   5\n", "a: &x {b: 1}\nc: *x\nd: !!str 5\n");
    expect("a: {b: , c: }\n", "a: {b: , c: }\n");
    expect("a:   # why\n  -   1\n", "a:   # why\n  - 1\n");
}

static void test_formulas_stay(void **state)
{
    (void)state;
    expect("a: [=b  *  2, \"=c  + 1\"]\n", "a: [=b  *  2, \"=c  + 1\"]\n");
    expect("a: b  c # d\n", "a: b  c # d\n");
}

static void test_indentation(void **state)
{
    (void)state;
    expect("a:\n      b:\n          c: 1\n      d: 2\n", "a:\n  b:\n    c: 1\n  d: 2\n");
    expect("  a: 1\n  b: 2\n", "a: 1\nb: 2\n");
    expect("a:\n- 1\n- b: 2\n  c: 3\nd: 4\n", "a:\n  - 1\n  - b: 2\n    c: 3\nd: 4\n");
    expect("a:\n-   b: 1\n    c:\n    - 2\n    e: 5\n",
           "a:\n  - b: 1\n    c:\n      - 2\n    e: 5\n");
    expect("-   -  1\n    -  2\n-\n   a: 1\n", "- - 1\n  - 2\n-\n  a: 1\n");
    expect("a:\n        [1,2]\n", "a:\n  [1, 2]\n");
    expect("a:\n   ?  b\n   :  c\n", "a:\n  ? b\n  : c\n");
}

static void test_lines_of_brackets_stay_in_line(void **state)
{
    (void)state;
    expect("a:    [1,\n       2,\n       3]\n", "a: [1,\n    2,\n    3]\n");
    expect("a:\n    b: {\n      c: 1,\n      d: [1,2],\n    }\n",
           "a:\n  b: {\n    c: 1,\n    d: [1, 2],\n  }\n");
}

static void test_texts_of_several_lines(void **state)
{
    (void)state;
    expect("a:\n    b: |\n       one\n         two  \n\n       # three\n    c: 1\n",
           "a:\n  b: |\n     one\n       two  \n\n     # three\n  c: 1\n");
    expect("a: |+\n one\n\n\n", "a: |+\n one\n\n\n");
    expect("a:\n    b: |2\n       one\n", "a:\n  b: |2\n     one\n");
    expect("a:\n    b: one\n      two\n    c: \"three\n      four\"\n",
           "a:\n  b: one\n    two\n  c: \"three\n    four\"\n");
}

static void test_comments(void **state)
{
    (void)state;
    expect("# a\n\n#b\na: 1 #c\n  # d\n", "# a\n\n#b\na: 1 #c\n  # d\n");
    expect("a:\n    # of b\n    b: 1\n    # of the end\n# of c\nc: 2\n",
           "a:\n  # of b\n  b: 1\n  # of the end\n# of c\nc: 2\n");
    expect("a:\n- b: 1\n  # inside\n# below\n- c\n",
           "a:\n  - b: 1\n    # inside\n  # below\n  - c\n");
    expect("a:\n        b: 1\n    # of a\n        # of b\nc: 2\n",
           "a:\n  b: 1\n  # of a\n  # of b\nc: 2\n");
    /* In columns, where there is more than one blank. */
    expect("a: 1     # one\nbc: [1,2] # two\nd: 3     # three\n",
           "a: 1     # one\nbc: [1, 2] # two\nd: 3     # three\n");
    expect("a: [1, # one\n\n\n    # two\n    2]\n", "a: [1, # one\n\n    # two\n    2]\n");
    expect("# only\n", "# only\n");
}

static void test_lines_and_blanks_at_ends(void **state)
{
    (void)state;
    expect("\n\na: 1  \n\n\n\nb: 2\t\n\n\n", "a: 1\n\nb: 2\n");
    expect("a: 1", "a: 1\n");
    expect("a: 1\r\nb:  2\r\n", "a: 1\nb: 2\n");
    expect("\xef\xbb\xbf"
           "a:  1\n",
           "a: 1\n");
    expect("%YAML 1.1\n---\na:  1\n...\n# end\n", "%YAML 1.1\n---\na: 1\n...\n# end\n");
    expect("", "");
    expect("\xc3\xa9:  [ \xc3\xa9,1]   # \xc3\xa9\n", "\xc3\xa9: [\xc3\xa9, 1]    # \xc3\xa9\n");
}

static void test_faults(void **state)
{
    (void)state;
    static const char *const texts[] = {"a: [1\n",   "a: 1\na: 2\n",      "a: *b\n",    "\x01",
                                        "a: \xff\n", "a: 1\n---\nb: 1\n", "a: !own 1\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        assert_null(format_or_null(texts[i]));
}

/* As deep as scenes may be, and a line as long as half a megabyte. */
static void test_large(void **state)
{
    (void)state;
    char deep[1024] = "";
    for (int i = 0; i < 60; i++)
        strcat(deep, "- ");
    strcat(deep, "1\n");
    expect(deep, deep);
    size_t values = 100000;
    char *line = malloc(5 * values + 8);
    assert_non_null(line);
    char *end = stpcpy(line, "a: [");
    for (size_t i = 0; i < values; i++)
        end = stpcpy(end, "1,");
    strcpy(end, "]\n");
    char *formatted = format_or_null(line);
    assert_non_null(formatted);
    assert_int_equal(strlen(formatted), strlen(line) + values - 1);
    free(formatted);
    free(line);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gaps),
        cmocka_unit_test(test_formulas_stay),
        cmocka_unit_test(test_indentation),
        cmocka_unit_test(test_lines_of_brackets_stay_in_line),
        cmocka_unit_test(test_texts_of_several_lines),
        cmocka_unit_test(test_comments),
        cmocka_unit_test(test_lines_and_blanks_at_ends),
        cmocka_unit_test(test_faults),
        cmocka_unit_test(test_large),
    };
    return RUN_TESTS(tests);
}
