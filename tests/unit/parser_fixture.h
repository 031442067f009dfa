/* parser_fixture.h: parses a text and compares all messages word by word, with their positions.
 *
 * Functions are static inline, as each test is a program of its own.
 */
#ifndef PARSER_FIXTURE_H
#define PARSER_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "parser/psd.h"
#include <string.h>

#define CAMERA "camera: {location: [0, 0, -1], look_at: [0, 0, 0]}\n"
#define LIGHTS "lights: [{point: {location: [0, 5, 0], intensity: 1}}]\n"
#define MATERIALS "materials: {white: {diffuse: 0.5}}\n"

/* What follows starts on line 5. */
#define HEAD "psd: 1\n" CAMERA LIGHTS MATERIALS
#define LONGEST_OUTPUT 16384

/* What the sink prints. */
static inline void print_all(const struct diagnostics *sink, char printed[LONGEST_OUTPUT])
{
    FILE *stream = tmpfile();
    assert_non_null(stream);
    diagnostics_print(sink, stream);
    rewind(stream);
    printed[fread(printed, 1, LONGEST_OUTPUT - 1, stream)] = '\0';
    fclose(stream);
}

/* Parses, and writes all messages, without the lines of source, as "line:column: error: ...\n". */
static inline ps_result parse(const char *text, size_t length,
                              struct scene_description *description, char messages[LONGEST_OUTPUT])
{
    char printed[LONGEST_OUTPUT];
    struct diagnostics *sink = diagnostics_create();
    assert_non_null(sink);
    ps_result result = psd_read_text("t", text, length, sink, description);
    assert_true((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    print_all(sink, printed);
    diagnostics_destroy(sink);
    messages[0] = '\0';
    for (char *line = strtok(printed, "\n"); line; line = strtok(NULL, "\n"))
        if (strncmp(line, "t:", 2) == 0) {
            strcat(messages, line + 2);
            strcat(messages, "\n");
        }
    return result;
}

/* Parses a text about which there is nothing to say. */
static inline struct scene_description parse_good(const char *text)
{
    struct scene_description description;
    char messages[LONGEST_OUTPUT];
    ps_result result = parse(text, strlen(text), &description, messages);
    assert_string_equal(messages, "");
    assert_int_equal(result, PS_OK);
    return description;
}

static inline void expect_bytes(const char *text, size_t length, const char *expected)
{
    struct scene_description description;
    char messages[LONGEST_OUTPUT];
    ps_result result = parse(text, length, &description, messages);
    assert_string_equal(messages, expected);
    assert_int_equal(result, PS_ERROR_INVALID);
    assert_null(description.path); /* released */
}

struct bad {
    const char *text, *messages;
};

static inline void expect_all(const struct bad *cases, size_t count)
{
    for (size_t i = 0; i < count; i++)
        expect_bytes(cases[i].text, strlen(cases[i].text), cases[i].messages);
}

#define EXPECT_ALL(cases) expect_all(cases, sizeof(cases) / sizeof(cases)[0])

#endif
