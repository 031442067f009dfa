/* Every section and key of the scene language is in psd(5), with its range, unit and default, and
 * no other is. */
#include "parser/schema/schema.h"

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

/* Rows that many sections share are documented in one, to which the others refer. */
static bool is_here(const struct schema_section *section, const struct schema_row *row)
{
    return !row->shared || strcmp(row->shared, section->name) == 0;
}

static void expected_line(const struct schema_section *section, const struct schema_row *row,
                          char *line, size_t size)
{
    char domain[256];
    if (!is_here(section, row)) {
        snprintf(line, size, "\n.Sx %s .\n", row->shared);
        return;
    }
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
    char name[64];
    schema_heading(section, name, sizeof name);
    snprintf(heading, sizeof heading, ".Ss %s", name);
    const char *start = find_part(heading, ends, &end);
    if (!start) {
        print_error("psd(5) has no section '%s'\n", heading);
        return 1;
    }
    size_t rows = 0;
    for (size_t i = 0; i < section->row_count; i++) {
        bool here = is_here(section, &section->rows[i]);
        expected_line(section, &section->rows[i], line, sizeof line);
        if (count_text(start, end, line) != 1) {
            print_error("psd(5), '%s': missing:%s", heading, line);
            missing++;
        }
        rows += here;
    }
    if (count_text(start, end, "\n.It ") != rows) {
        print_error("psd(5), '%s': %zu keys, the table has %zu\n", heading,
                    count_text(start, end, "\n.It "), rows);
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

/* Where a key holds sections of several kinds, its text names all of them. */
static void expect_kinds(const struct schema_section *section, const struct schema_row *row)
{
    static const char *const ends[] = {"\n.It ", "\n.El", NULL};
    char line[1024], heading[1024], name[80];
    const char *end;
    expected_line(section, row, line, sizeof line);
    snprintf(heading, sizeof heading, "%.*s", (int)strlen(line) - 2, line + 1);
    const char *start = find_part(heading, ends, &end);
    assert_non_null(start);
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *kind = schema_section(i);
        snprintf(name, sizeof name, "%s", kind->name);
        if (strcmp(kind->family, row->family) == 0 && count_text(start, end, name) == 0)
            fail_msg("psd(5): '%s' does not name '%s'", row->param.name, kind->name);
    }
}

static void test_lists_name_their_kinds(void **state)
{
    (void)state;
    const struct schema_section *scene = schema_only("scene");
    for (size_t i = 0; i < scene->row_count; i++)
        if (scene->rows[i].form == SCHEMA_LIST)
            expect_kinds(scene, &scene->rows[i]);
}

/* The patterns stand in a part of their own, as many keys take them. */
static void test_patterns_are_named(void **state)
{
    static const char *const ends[] = {"\n.Sh ", "\n.Ss ", NULL};
    (void)state;
    const char *end;
    const char *start = find_part(".Sh PATTERNS", ends, &end);
    assert_non_null(start);
    for (size_t i = 0; i < schema_section_count(); i++) {
        char item[80];
        snprintf(item, sizeof item, "\n.It Cm %s\n", schema_section(i)->name);
        if (strcmp(schema_section(i)->family, "pigments") == 0 && count_text(start, end, item) != 1)
            fail_msg("psd(5), PATTERNS: no '%s'", schema_section(i)->name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys_are_documented),
        cmocka_unit_test(test_no_other_section_is_documented),
        cmocka_unit_test(test_lists_name_their_kinds),
        cmocka_unit_test(test_patterns_are_named),
    };
    return cmocka_run_group_tests(tests, read_page, NULL);
}
