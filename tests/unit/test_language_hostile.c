/* test_language_hostile.c: short texts that mean to become large, or to take forever. What takes
 * forever ends by the time limit of the test. */
#include "language_fixture.h"
#include "support/run_tests.h"

static const struct reading alone = {.files = NULL};
static const struct reading small = {.files = NULL, .most_values = 1000};

static void expect_refused(const char *text, const struct reading *reading, const char *message)
{
    struct scene_description d;
    static char messages[LONGEST_OUTPUT];
    assert_int_equal(read_as(text, reading, &d, messages), PS_ERROR_INVALID);
    if (!strstr(messages, message))
        fail_msg("expected '%s', got '%s'", message, messages);
}

static void test_loops_are_counted(void **state)
{
    (void)state;
    /* Turns count even where they make nothing. */
    expect_refused(HEAD
                   "objects: [{for: i, from: 1, to: 3e6, do: {for: j, from: 1, to: 3e6, do: []}}]",
                   &alone, "error: more than 4000000 values in one scene\n");
    expect_refused(HEAD "objects: [{for: i, from: 1, to: 3e6, do: {for: j, in: [1, 2, 3], do: }}]",
                   &alone, "error: more than 4000000 values in one scene\n");
    expect_refused(HEAD "objects: [{for: i, from: 1, to: 3e6, do: {if: no, do: []}}]", &alone,
                   "error: more than 4000000 values in one scene\n");
    expect_refused(HEAD "objects: [{for: i, from: 1, to: 1e18, do: []}]", &alone,
                   "turns; a scene has at most");
    expect_refused(HEAD "objects: [{for: i, from: -1e308, to: 1e308, step: 1e-300, do: []}]",
                   &alone, "error: this loop has inf turns");
    expect_refused(HEAD "objects: [{for: i, from: 1, to: 1e6, do: {sphere: {center: [=i, 2, 3], "
                        "radius: 1, material: white}}}]",
                   &alone, "error: more than 4000000 values in one scene\n");
    expect_refused(HEAD "objects: [{for: i, from: 1, to: 200, do: [[1, 2, 3, =i]]}]", &small,
                   "error: more than 1000 values in one scene\n");
    /* A turn that does not move the index. */
    expect_refused(HEAD "objects: [{for: i, from: 1e300, to: 1e300, step: 1e-300, do: [5]}]",
                   &alone, "expected a map with one key in objects, got text\n");
}

static void test_names_are_counted(void **state)
{
    (void)state;
    char text[8192] = HEAD "define:\n  a: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
    for (char name = 'b'; name <= 'p'; name++)
        sprintf(text + strlen(text), "  %c: [=%c, =%c, =%c, =%c, =%c, =%c, =%c, =%c, =%c]\n", name,
                name - 1, name - 1, name - 1, name - 1, name - 1, name - 1, name - 1, name - 1,
                name - 1);
    expect_refused(text, &alone, "error: more than 4000000 values in one scene\n");
    strcpy(text, HEAD "define:\n  a1: [1]\n");
    for (int i = 2; i < 80; i++)
        sprintf(text + strlen(text), "  a%d: {k: =a%d}\n", i, i - 1);
    expect_refused(text, &alone, "t:70:12: error: nested deeper than 64 levels\n");
}

/* Aliases are shared, but visited once for each. */
static void test_loops_times_aliases(void **state)
{
    (void)state;
    expect_refused(HEAD "image: {width: x}\nobjects:\n"
                        "  - for: i\n    from: 1\n    to: 1000\n    do: &a\n"
                        "      - {for: j, from: 1, to: 1000, do: [5, 5, 5, 5, 5]}\n"
                        "  - {for: k, in: [1, 2], do: [*a, *a, *a, *a]}\n",
                   &alone, "error: more than 4000000 values in one scene\n");
}

static char *fill_text(const char *start, const char *piece, size_t count, const char *end)
{
    size_t length = strlen(piece);
    char *text = malloc(strlen(start) + count * length + strlen(end) + 1), *at = text;
    assert_non_null(text);
    at += sprintf(at, "%s", start);
    for (size_t i = 0; i < count; i++, at += length)
        memcpy(at, piece, length);
    strcpy(at, end);
    return text;
}

static void test_formulas_are_counted(void **state)
{
    (void)state;
    char *text =
        fill_text(HEAD "objects:\n  - {for: i, from: 1, to: 1e6, do: \"=i", "+1", 100000, "\"}\n");
    expect_refused(text, &alone,
                   "error: loops and aliases make more than 64000000 characters of formulas\n");
    free(text);
    text = fill_text(HEAD "image: {width: =", "a", 3000000, "}\n");
    expect_refused(text, &alone, "error: unknown name 'aaaaaaa");
    free(text);
    text = fill_text(HEAD "image: {width: =", "(", 3000000, "}\n");
    expect_refused(text, &alone, "error: the arithmetic is nested too deeply\n");
    free(text);
    text = fill_text(HEAD "image: {width: \"=max(1", ",1", 1000000, ")\"}\n");
    expect_refused(text, &alone, "error: max takes 2 to 8 arguments, got 1000001\n");
    free(text);
}

/* Wrong in every turn, in another way each time; with many names to suggest. */
static void test_errors_are_counted(void **state)
{
    (void)state;
    char *text = malloc(8000000), *at = text;
    assert_non_null(text);
    at += sprintf(at, HEAD "define:\n");
    for (int i = 0; i < 100000; i++)
        at += sprintf(at, "  name_number_%d: %d\n", i, i);
    at += sprintf(at, "objects:\n");
    for (int i = 0; i < 100000; i++)
        at += sprintf(at, "  - =nmae_nubmer_%d\n", i);
    expect_refused(text, &alone,
                   "error: unknown name 'nmae_nubmer_0' in arithmetic; did you mean "
                   "'name_number_0'?\n");
    free(text);
    expect_refused(HEAD
                   "objects: [{for: i, from: 1, to: 1e6, do: {for: j, in: [=1/0], do: [=i/0]}}]",
                   &alone, "t:5:58: error: division by zero\n");
}

static void test_many_parameters(void **state)
{
    (void)state;
    const size_t count = 100000;
    const char **words = calloc(count, sizeof *words);
    assert_non_null(words);
    for (size_t i = 0; i < count; i++)
        words[i] = "nmae=1";
    struct scene_description d;
    struct diagnostics *sink = diagnostics_create();
    const struct psd_options options = {.parameters = words, .parameter_count = count};
    const char *text = HEAD "parameters: {name: {default: 3}}\n";
    assert_int_equal(psd_read_text_with("t", text, strlen(text), &options, sink, &d),
                     PS_ERROR_INVALID);
    diagnostics_destroy(sink);
    free(words);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_loops_are_counted),   cmocka_unit_test(test_names_are_counted),
        cmocka_unit_test(test_loops_times_aliases), SLOW_TEST(test_formulas_are_counted),
        cmocka_unit_test(test_errors_are_counted),  cmocka_unit_test(test_many_parameters),
    };
    return RUN_TESTS(tests);
}
