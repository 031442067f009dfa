/* schema_json.c: see schema_json.h. One definition for each section, each family of several
 * sections, and what many values have in common.
 */
#include "parser/schema/schema_json.h"

#include "base/text.h"
#include "parser/schema/schema_json_value.h"
#include <string.h>

/* A formula; and numbers such as 1e6, which are text to some readers of YAML 1.1. */
#define FORMULA "^(=.*|[+-]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][+-]?[0-9]+)?)$"

#define NAME_TEXT 80

static bool is_alone(const struct schema_section *section)
{
    return strcmp(section->name, section->family) == 0;
}

/* "camera", "lights.point" */
static void section_name(const struct schema_section *section, char name[NAME_TEXT])
{
    if (is_alone(section))
        snprintf(name, NAME_TEXT, "%s", section->name);
    else
        snprintf(name, NAME_TEXT, "%s.%s", section->family, section->name);
}

/* Defaults are JSON, but for words. */
static void write_default(struct json_writer *writer, const struct schema_row *row)
{
    const char *text = row->param.default_value;
    double number;
    if (!text)
        return;
    json_writer_key(writer, "default");
    if (row->form == SCHEMA_WORDS) {
        json_writer_open(writer, '[');
        for (size_t i = 0; row->param.choices[i]; i++)
            if (strstr(text, row->param.choices[i]))
                json_writer_text(writer, row->param.choices[i]);
        json_writer_close(writer, '[');
    } else if (row->param.type == PS_PARAM_BOOL) {
        json_writer_raw(writer, strcmp(text, "yes") == 0 ? "true" : "false");
    } else if (text_to_number(text, &number) || text[0] == '[') {
        json_writer_raw(writer, text);
    } else {
        json_writer_text(writer, text);
    }
}

static void write_description(struct json_writer *writer, const struct schema_row *row)
{
    char text[512], domain[256];
    const char *unit = row->param.unit, *absent = row->absent;
    schema_describe(row, domain, sizeof domain);
    snprintf(text, sizeof text, "%s (%s%s%s%s%s)", row->param.help, domain, unit[0] ? ", in " : "",
             unit, absent ? "; if absent: " : "", absent ? absent : "");
    json_writer_text_of(writer, "description", text);
}

static void write_row(struct json_writer *writer, const struct schema_row *row)
{
    json_writer_open_of(writer, row->param.name, '{');
    write_description(writer, row);
    write_default(writer, row);
    json_writer_open_of(writer, "anyOf", '[');
    schema_json_alternatives(writer, row);
    schema_json_reference(writer, "formula");
    schema_json_reference(writer, "repeated");
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
}

/* {"required": [KEY, KEY]} */
static void write_required(struct json_writer *writer, const char *first, const char *second)
{
    json_writer_open(writer, '{');
    json_writer_open_of(writer, "required", '[');
    json_writer_text(writer, first);
    if (second)
        json_writer_text(writer, second);
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
}

/* Pairs of keys that exclude each other. */
static void write_exclusions(struct json_writer *writer, const struct schema_section *section)
{
    for (size_t i = 0; i < section->row_count; i++)
        for (size_t j = i + 1; j < section->row_count; j++) {
            const struct schema_row *a = &section->rows[i], *b = &section->rows[j];
            if (a->choice == 0 || a->choice != b->choice || a->alternative == b->alternative)
                continue;
            json_writer_open(writer, '{');
            json_writer_key(writer, "not");
            write_required(writer, a->param.name, b->param.name);
            json_writer_close(writer, '{');
        }
}

/* A section has at most one choice of which something must be given. */
static void write_demand(struct json_writer *writer, const struct schema_section *section)
{
    bool any = false;
    for (size_t i = 0; i < section->row_count; i++) {
        if (!section->rows[i].demanded)
            continue;
        if (!any) {
            json_writer_open(writer, '{');
            json_writer_open_of(writer, "anyOf", '[');
            any = true;
        }
        write_required(writer, section->rows[i].param.name, NULL);
    }
    if (any) {
        json_writer_close(writer, '[');
        json_writer_close(writer, '{');
    }
}

/* A merge key may bring what is missing. */
static void write_rules(struct json_writer *writer, const struct schema_section *section)
{
    json_writer_raw_of(writer, "if", "{\"type\": \"object\", \"not\": {\"required\": [\"<<\"]}}");
    json_writer_open_of(writer, "then", '{');
    json_writer_open_of(writer, "required", '[');
    for (size_t i = 0; i < section->row_count; i++)
        if (schema_is_required(&section->rows[i]))
            json_writer_text(writer, section->rows[i].param.name);
    json_writer_close(writer, '[');
    json_writer_open_of(writer, "allOf", '[');
    json_writer_raw(writer, "true");
    write_exclusions(writer, section);
    write_demand(writer, section);
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
}

static void write_section(struct json_writer *writer, const struct schema_section *section)
{
    char name[NAME_TEXT], pattern[NAME_TEXT];
    section_name(section, name);
    json_writer_open_of(writer, name, '{');
    json_writer_text_of(writer, "description", section->summary);
    json_writer_raw_of(writer, "type", "[\"object\", \"null\", \"string\"]");
    snprintf(pattern, sizeof pattern, section->word ? "^(=|%s$)" : "^=", section->word);
    json_writer_text_of(writer, "pattern", pattern);
    json_writer_open_of(writer, "properties", '{');
    for (size_t i = 0; i < section->row_count; i++)
        write_row(writer, &section->rows[i]);
    json_writer_raw_of(writer, "<<", "true");
    json_writer_close(writer, '{');
    json_writer_raw_of(writer, "additionalProperties", "false");
    write_rules(writer, section);
    json_writer_close(writer, '{');
}

/* {KIND: {...}}, of the kinds of a family; in lists, loops may stand in its place. */
static void write_family(struct json_writer *writer, const char *family)
{
    json_writer_open_of(writer, family, '{');
    json_writer_raw_of(writer, "if", "{\"$ref\": \"#/$defs/loop\"}");
    json_writer_raw_of(writer, "then", "true");
    json_writer_open_of(writer, "else", '{');
    json_writer_raw_of(writer, "type", "[\"object\", \"string\"]");
    json_writer_raw_of(writer, "pattern", "\"^=\"");
    json_writer_open_of(writer, "properties", '{');
    for (size_t i = 0; i < schema_section_count(); i++) {
        char name[NAME_TEXT];
        const struct schema_section *section = schema_section(i);
        section_name(section, name);
        if (strcmp(section->family, family) != 0)
            continue;
        json_writer_key(writer, section->name);
        schema_json_reference(writer, name);
    }
    json_writer_close(writer, '{');
    json_writer_raw_of(writer, "additionalProperties", "false");
    json_writer_raw_of(writer, "minProperties", "1");
    json_writer_raw_of(writer, "maxProperties", "1");
    json_writer_close(writer, '{');
    json_writer_close(writer, '{');
}

static bool is_first_of_family(size_t index)
{
    const struct schema_section *section = schema_section(index);
    for (size_t i = 0; i < index; i++)
        if (strcmp(schema_section(i)->family, section->family) == 0)
            return false;
    return !is_alone(section);
}

/* What many values have in common. */
static void write_common(struct json_writer *writer)
{
    json_writer_open_of(writer, "formula", '{');
    json_writer_text_of(writer, "type", "string");
    json_writer_text_of(writer, "pattern", FORMULA);
    json_writer_close(writer, '{');
    json_writer_raw_of(writer, "text", "{\"type\": [\"string\", \"number\", \"boolean\"]}");
    json_writer_raw_of(
        writer, "yes_or_no",
        "{\"enum\": [true, false, \"yes\", \"no\", \"on\", \"off\", \"true\", \"false\", "
        "0, 1]}");
    json_writer_raw_of(writer, "loop",
                       "{\"type\": \"object\", \"anyOf\": [{\"required\": [\"for\", \"do\"]}, "
                       "{\"required\": [\"if\"]}]}");
    json_writer_raw_of(writer, "repeated",
                       "{\"description\": \"a list with loops\", \"type\": \"array\", "
                       "\"contains\": {\"$ref\": \"#/$defs/loop\"}}");
    json_writer_raw_of(
        writer, "strategy",
        "{\"anyOf\": [{\"type\": \"string\"}, {\"type\": \"object\", \"minProperties\": 1, "
        "\"maxProperties\": 1, \"additionalProperties\": {\"type\": [\"object\", "
        "\"null\", \"string\"]}}]}");
}

void schema_json_write(FILE *stream)
{
    struct json_writer writer = {.stream = stream};
    json_writer_open(&writer, '{');
    json_writer_text_of(&writer, "$schema", "https://json-schema.org/draft/2020-12/schema");
    json_writer_text_of(&writer, "title", "scene of psplat (psd 1)");
    json_writer_raw_of(&writer, "$ref", "\"#/$defs/scene\"");
    json_writer_open_of(&writer, "$defs", '{');
    write_common(&writer);
    for (size_t i = 0; i < schema_section_count(); i++) {
        if (is_first_of_family(i))
            write_family(&writer, schema_section(i)->family);
        write_section(&writer, schema_section(i));
    }
    json_writer_close(&writer, '{');
    json_writer_close(&writer, '{');
    fputc('\n', stream);
}
