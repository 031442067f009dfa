/* test_diagnostic.c: how errors and warnings are kept, sorted and printed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "parser/yaml/diagnostic.h"
#include <string.h>

#define LONGEST_OUTPUT 16384

static const char text[] = "one two\nthr\xc3\xa9\xc3\xa9 four\r\n\tfive\x1b[31m six\nseven";

static struct diagnostics *create(void)
{
    struct diagnostics *sink = diagnostics_create();
    assert_non_null(sink);
    assert_string_equal(diagnostics_add_source(sink, "a.psd", text, sizeof text - 1), "a.psd");
    return sink;
}

static void report_at(struct diagnostics *sink, const char *file, int line, int column, int width,
                      const char *message)
{
    struct origin origin = {file, line, column};
    diagnostics_report(sink, SEVERITY_ERROR, &origin, width, "%s", message);
}

static void expect_printed(struct diagnostics *sink, const char *expected)
{
    char printed[LONGEST_OUTPUT];
    FILE *stream = tmpfile();
    assert_non_null(stream);
    diagnostics_print(sink, stream);
    rewind(stream);
    printed[fread(printed, 1, sizeof printed - 1, stream)] = '\0';
    fclose(stream);
    assert_string_equal(printed, expected);
    diagnostics_destroy(sink);
}

static void test_caret(void **state)
{
    (void)state;
    struct diagnostics *sink = create();
    struct origin origin = {"a.psd", 1, 5};
    diagnostics_report(sink, SEVERITY_ERROR, &origin, 3, "no %s but %d", "two", 2);
    assert_int_equal(diagnostics_error_count(sink), 1);
    expect_printed(sink, "a.psd:1:5: error: no two but 2\n"
                         "    1 | one two\n"
                         "      |     ^~~\n");
}

static void test_characters_are_counted_not_bytes(void **state)
{
    (void)state;
    struct diagnostics *sink = create();
    report_at(sink, "a.psd", 2, 7, 99, "far");
    expect_printed(sink, "a.psd:2:7: error: far\n"
                         "    2 | thr\xc3\xa9\xc3\xa9 four\n"
                         "      |       ^~~~\n");
}

static void test_terminal_is_safe(void **state)
{
    (void)state;
    struct diagnostics *sink = create();
    report_at(sink, "a.psd", 3, 2, 0, "got '\x1b[31m\xff\n\xc2\x9b'");
    expect_printed(sink, "a.psd:3:2: error: got '?[31m?\?\?'\n"
                         "    3 |  five?[31m six\n"
                         "      |  ^\n");
}

static void test_order_and_count(void **state)
{
    (void)state;
    struct diagnostics *sink = create();
    struct origin origin = {"a.psd", 4, 1};
    assert_non_null(diagnostics_add_source(sink, "b.psd", "x", 1));
    report_at(sink, "b.psd", 1, 1, 1, "in b");
    diagnostics_report(sink, SEVERITY_WARNING, &origin, 1, "careful");
    report_at(sink, "a.psd", 1, 5, 1, "second");
    report_at(sink, "a.psd", 1, 1, 1, "first");
    report_at(sink, "a.psd", 1, 5, 1, "third");
    report_at(sink, "a.psd", 1, 5, 1, "second");
    assert_int_equal(diagnostics_error_count(sink), 4);
    assert_int_equal(diagnostics_warning_count(sink), 1);
    expect_printed(sink, "a.psd:1:1: error: first\n    1 | one two\n      | ^\n"
                         "a.psd:1:5: error: second\n    1 | one two\n      |     ^\n"
                         "a.psd:1:5: error: third\n    1 | one two\n      |     ^\n"
                         "a.psd:4:1: warning: careful\n    4 | seven\n      | ^\n"
                         "b.psd:1:1: error: in b\n    1 | x\n      | ^\n"
                         "4 errors\n");
}

static void test_no_position(void **state)
{
    (void)state;
    struct diagnostics *sink = create();
    diagnostics_report(sink, SEVERITY_WARNING, NULL, 0, "nowhere");
    report_at(sink, "c.psd", 0, 0, 0, "cannot open");
    report_at(sink, "a.psd", 99, 1, 1, "after the end");
    expect_printed(sink, "a.psd:99:1: error: after the end\n"
                         "c.psd: error: cannot open\n"
                         "psplat: warning: nowhere\n"
                         "2 errors\n");
}

struct visits {
    char text[LONGEST_OUTPUT];
    size_t count;
    struct origin last;
};

static void note(void *user, enum severity severity, const struct origin *origin, const char *words)
{
    struct visits *visits = user;
    size_t used = strlen(visits->text);
    snprintf(visits->text + used, sizeof visits->text - used, "%d[%s]", (int)severity, words);
    visits->last = *origin;
    visits->count++;
}

static void test_each(void **state)
{
    (void)state;
    struct diagnostics *sink = create();
    struct visits visits = {.count = 0};
    diagnostics_each(sink, note, &visits);
    assert_int_equal(visits.count, 0);
    diagnostics_report(sink, SEVERITY_ERROR, NULL, 0, "nowhere");
    report_at(sink, "a.psd", 1, 5, 2, "wrong");
    diagnostics_each(sink, note, &visits);
    assert_int_equal(visits.count, 2);
    assert_string_equal(visits.text, "1[a.psd:1:5: error: wrong\n    1 | one two\n      |     ^~]"
                                     "1[nowhere]");
    assert_null(visits.last.file);
    assert_int_equal(visits.last.line, 0);
    diagnostics_destroy(sink);
}

static void test_errors_past_the_cap_are_counted(void **state)
{
    (void)state;
    struct diagnostics *sink = diagnostics_create();
    char expected[LONGEST_OUTPUT] = "";
    assert_non_null(sink);
    for (int i = 1; i <= DIAGNOSTICS_KEPT + 5; i++) {
        char line[64];
        assert_int_equal(diagnostics_is_full(sink), i > DIAGNOSTICS_KEPT);
        report_at(sink, "d.psd", i, 1, 1, "bad");
        snprintf(line, sizeof line, "d.psd:%d:1: error: bad\n", i);
        if (i <= DIAGNOSTICS_KEPT)
            strcat(expected, line);
    }
    strcat(expected, "25 errors (20 shown)\n");
    assert_int_equal(diagnostics_error_count(sink), DIAGNOSTICS_KEPT + 5);
    expect_printed(sink, expected);
}

static void test_keeps_as_many_as_asked(void **state)
{
    (void)state;
    struct diagnostics *sink = diagnostics_create_for(2);
    assert_non_null(sink);
    for (int i = 1; i <= 3; i++) {
        const struct origin origin = {"d.psd", i, 1};
        diagnostics_report(sink, SEVERITY_WARNING, &origin, 1, "odd");
    }
    assert_int_equal(diagnostics_warning_count(sink), 3);
    expect_printed(sink, "d.psd:1:1: warning: odd\nd.psd:2:1: warning: odd\n"
                         "3 warnings (2 shown)\n");
}

static void test_long_lines_are_cut(void **state)
{
    (void)state;
    struct diagnostics *sink = diagnostics_create();
    char line[1000], expected[LONGEST_OUTPUT];
    assert_non_null(sink);
    memset(line, 'x', sizeof line);
    memcpy(line + 500, "here", 4);
    assert_non_null(diagnostics_add_source(sink, "e.psd", line, sizeof line));
    report_at(sink, "e.psd", 1, 501, 4, "bad");
    snprintf(expected, sizeof expected,
             "e.psd:1:501: error: bad\n    1 | %.60shere%.56s\n      | %60s^~~~\n", line, line, "");
    expect_printed(sink, expected);
}

static void test_byte_order_mark_is_no_column(void **state)
{
    (void)state;
    struct diagnostics *sink = diagnostics_create();
    assert_non_null(sink);
    assert_non_null(diagnostics_add_source(sink, "f.psd", "\xef\xbb\xbfpsd", 6));
    report_at(sink, "f.psd", 1, 1, 3, "bad");
    expect_printed(sink, "f.psd:1:1: error: bad\n    1 | psd\n      | ^~~\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_caret),
        cmocka_unit_test(test_characters_are_counted_not_bytes),
        cmocka_unit_test(test_terminal_is_safe),
        cmocka_unit_test(test_order_and_count),
        cmocka_unit_test(test_no_position),
        cmocka_unit_test(test_each),
        cmocka_unit_test(test_errors_past_the_cap_are_counted),
        cmocka_unit_test(test_keeps_as_many_as_asked),
        cmocka_unit_test(test_long_lines_are_cut),
        cmocka_unit_test(test_byte_order_mark_is_no_column),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
