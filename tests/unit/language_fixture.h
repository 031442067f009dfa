/* language_fixture.h: reads scenes of several files that lie in memory, with what a command line
 * may say, and compares descriptions and messages.
 *
 * Functions are static inline, as each test is a program of its own.
 */
#ifndef LANGUAGE_FIXTURE_H
#define LANGUAGE_FIXTURE_H

#include "parser_fixture.h"

#include <ctype.h>
#include <stdlib.h>

#define MOST_WORDS 8

/* A file, or the end of a list of them. */
struct memory_file {
    const char *path, *text;
};

/* How a scene is read; its main file is called "t". */
struct reading {
    const struct memory_file *files;
    const char *parameters[MOST_WORDS], *sets[MOST_WORDS];
    size_t most_values;
};

static inline ps_result read_memory(void *user, const char *path, size_t most,
                                    struct file_text *text, struct error *error)
{
    const struct memory_file *file = user;
    while (file && file->path && strcmp(file->path, path) != 0)
        file++;
    if (!file || !file->path)
        return error_set(error, PS_ERROR_IO, "not there");
    text->length = strlen(file->text);
    text->bytes = malloc(text->length + 1);
    assert_non_null(text->bytes);
    memcpy(text->bytes, file->text, text->length + 1);
    assert_true(text->length <= most);
    return PS_OK;
}

static inline size_t count_words(const char *const words[MOST_WORDS])
{
    size_t count = 0;
    while (count < MOST_WORDS && words[count])
        count++;
    return count;
}

/* All that is printed but lines of source, carets and the number of errors. */
static inline void keep_messages(char *printed, char messages[LONGEST_OUTPUT])
{
    messages[0] = '\0';
    for (char *line = strtok(printed, "\n"); line; line = strtok(NULL, "\n"))
        if ((strlen(line) < 8 || strncmp(line + 5, " | ", 3) != 0) && !isdigit((int)line[0])) {
            strcat(messages, line);
            strcat(messages, "\n");
        }
}

static inline ps_result read_as(const char *text, const struct reading *reading,
                                struct scene_description *description,
                                char messages[LONGEST_OUTPUT])
{
    char printed[LONGEST_OUTPUT];
    struct diagnostics *sink = diagnostics_create();
    const struct psd_files files = {(void *)reading->files, read_memory};
    const struct psd_options options = {.parameters = reading->parameters,
                                        .parameter_count = count_words(reading->parameters),
                                        .sets = reading->sets,
                                        .set_count = count_words(reading->sets),
                                        .files = &files,
                                        .most_values = reading->most_values};
    assert_non_null(sink);
    ps_result result = psd_read_text_with("t", text, strlen(text), &options, sink, description);
    assert_true((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    print_all(sink, printed);
    diagnostics_destroy(sink);
    keep_messages(printed, messages);
    return result;
}

static inline struct scene_description expect_good(const char *text, const struct reading *reading)
{
    struct scene_description description;
    char messages[LONGEST_OUTPUT];
    ps_result result = read_as(text, reading, &description, messages);
    assert_string_equal(messages, "");
    assert_int_equal(result, PS_OK);
    return description;
}

static inline void expect_bad(const char *text, const struct reading *reading, const char *expected)
{
    struct scene_description description;
    char messages[LONGEST_OUTPUT];
    ps_result result = read_as(text, reading, &description, messages);
    assert_string_equal(messages, expected);
    assert_int_equal(result, PS_ERROR_INVALID);
    assert_null(description.path); /* released */
}

static inline void assert_vector(ps_vec3 v, double x, double y, double z)
{
    assert_true(v.x == (float)x && v.y == (float)y && v.z == (float)z);
}

#endif
