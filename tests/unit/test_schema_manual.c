/* Every section and key of the scene language is in psd(5), with its range, unit and default, and
 * no other is. */
#include "parser/schema.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define LARGEST_PAGE ((size_t)1 << 20)

static char page[LARGEST_PAGE]; /* man/psd.5, after a newline */

static int read_page(void **state)
{
    (void)state;
    const char *source = getenv("PSPLAT_SOURCE");
    char path[4096];
    if (!source)
        return -1;
    snprintf(path, sizeof path, "%s/man/psd.5", source);
    FILE *file = fopen(path, "rb");
    if (!file)
        return -1;
    page[0] = '\n';
    size_t length = fread(page + 1, 1, LARGEST_PAGE - 2, file);
    fclose(file);
    return length > 0 && length < LARGEST_PAGE - 2 ? 0 : -1;
}

/* The line behind a heading, or NULL; where its part of the page ends goes to `end`. */
static const char *find_part(const char *heading, const char *const ends[], const char **end)
{
    char line[128];
    snprintf(line, sizeof line, "\n%s\n", heading);
    const char *start = strstr(page, line);
    if (!start)
        return NULL;
    start += strlen(line) - 1;
    *end = page + strlen(page);
    for (size_t i = 0; ends[i]; i++) {
        const char *found = strstr(start, ends[i]);
        if (found && found < *end)
            *end = found;
    }
    return start;
}

static size_t count_text(const char *start, const char *end, const char *text)
{
    size_t count = 0;
    for (const char *at = strstr(start, text); at && at < end; at = strstr(at + 1, text))
        count++;
    return count;
}

static void expected_line(const struct schema_row *row, char *line, size_t size)
{
    char domain[256];
    const ps_param *param = &row->param;
    schema_describe(row, domain, sizeof domain);
    const char *fallback = param->default_value ? param->default_value : row->absent;
    snprintf(line, size, "\n.It Cm %s : No %s%s%s; %s%s\n", param->name, domain,
             param->unit[0] ? ", in " : "", param->unit,
             schema_is_required(row) ? "required"
             : param->default_value  ? "default: "
                                     : "if absent: ",
             schema_is_required(row) ? "" : fallback);
}

static size_t count_missing(const struct schema_section *section)
{
    static const char *const ends[] = {"\n.Ss ", "\n.Sh ", NULL};
    char heading[128], line[1024];
    const char *end;
    size_t missing = 0;
    snprintf(heading, sizeof heading, ".Ss %s", section->name);
    const char *start = find_part(heading, ends, &end);
    if (!start) {
        print_error("psd(5) has no section '%s'\n", heading);
        return 1;
    }
    for (size_t i = 0; i < section->row_count; i++) {
        expected_line(&section->rows[i], line, sizeof line);
        if (count_text(start, end, line) != 1) {
            print_error("psd(5), '%s': missing:%s", heading, line);
            missing++;
        }
    }
    if (count_text(start, end, "\n.It ") != section->row_count) {
        print_error("psd(5), '%s': %zu keys, the table has %zu\n", heading,
                    count_text(start, end, "\n.It "), section->row_count);
        missing++;
    }
    return missing;
}

static void test_keys_are_documented(void **state)
{
    (void)state;
    size_t missing = 0;
    for (size_t i = 0; i < schema_section_count(); i++)
        missing += count_missing(schema_section(i));
    assert_int_equal(missing, 0);
}

static void test_no_other_section_is_documented(void **state)
{
    static const char *const ends[] = {"\n.Sh ", NULL};
    const char *end = page;
    (void)state;
    const char *start = find_part(".Sh SECTIONS", ends, &end);
    assert_non_null(start);
    assert_int_equal(count_text(start, end, "\n.Ss "), schema_section_count());
}

/* A map's items are sections; those that a list or a map of names can hold are named there. */
static void test_parts_name_their_sections(void **state)
{
    static const char *const ends[] = {"\n.It ", "\n.El", NULL};
    (void)state;
    const struct schema_section *scene = schema_find(NULL, "scene");
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *section = schema_section(i);
        if (!section->parent)
            continue;
        char heading[1024], line[1024];
        const char *end;
        for (size_t j = 0; j < scene->row_count; j++)
            if (strcmp(scene->rows[j].param.name, section->parent) == 0)
                expected_line(&scene->rows[j], line, sizeof line);
        snprintf(heading, sizeof heading, "%.*s", (int)strlen(line) - 2, line + 1);
        const char *start = find_part(heading, ends, &end);
        assert_non_null(start);
        if (count_text(start, end, section->name) == 0)
            fail_msg("psd(5): '%s' does not name '%s'", section->parent, section->name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys_are_documented),
        cmocka_unit_test(test_no_other_section_is_documented),
        cmocka_unit_test(test_parts_name_their_sections),
    };
    return cmocka_run_group_tests(tests, read_page, NULL);
}
