/* schema_json.c: see schema_json.h. One definition for each section, each family of several sections,
 * and what many values have in common.
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
static void write_default(struct emitter *emitter, const struct schema_row *row)
{
    const char *text = row->param.default_value;
    double number;
    if (!text)
        return;
    emit_key(emitter, "default");
    if (row->form == SCHEMA_WORDS) {
        emit_open(emitter, '[');
        for (size_t i = 0; row->param.choices[i]; i++)
            if (strstr(text, row->param.choices[i]))
                emit_text(emitter, row->param.choices[i]);
        emit_close(emitter, '[');
    } else if (row->param.type == PS_PARAM_BOOL) {
        emit_raw(emitter, strcmp(text, "yes") == 0 ? "true" : "false");
    } else if (text_to_number(text, &number) || text[0] == '[') {
        emit_raw(emitter, text);
    } else {
        emit_text(emitter, text);
    }
}

static void write_description(struct emitter *emitter, const struct schema_row *row)
{
    char text[512], domain[256];
    const char *unit = row->param.unit, *absent = row->absent;
    schema_describe(row, domain, sizeof domain);
    snprintf(text, sizeof text, "%s (%s%s%s%s%s)", row->param.help, domain, unit[0] ? ", in " : "",
             unit, absent ? "; if absent: " : "", absent ? absent : "");
    emit_text_of(emitter, "description", text);
}

static void write_row(struct emitter *emitter, const struct schema_row *row)
{
    emit_open_of(emitter, row->param.name, '{');
    write_description(emitter, row);
    write_default(emitter, row);
    emit_open_of(emitter, "anyOf", '[');
    schema_json_alternatives(emitter, row);
    schema_json_reference(emitter, "formula");
    schema_json_reference(emitter, "repeated");
    emit_close(emitter, '[');
    emit_close(emitter, '{');
}

/* {"required": [KEY, KEY]} */
static void write_required(struct emitter *emitter, const char *first, const char *second)
{
    emit_open(emitter, '{');
    emit_open_of(emitter, "required", '[');
    emit_text(emitter, first);
    if (second)
        emit_text(emitter, second);
    emit_close(emitter, '[');
    emit_close(emitter, '{');
}

/* Pairs of keys that exclude each other. */
static void write_exclusions(struct emitter *emitter, const struct schema_section *section)
{
    for (size_t i = 0; i < section->row_count; i++)
        for (size_t j = i + 1; j < section->row_count; j++) {
            const struct schema_row *a = &section->rows[i], *b = &section->rows[j];
            if (a->choice == 0 || a->choice != b->choice || a->alternative == b->alternative)
                continue;
            emit_open(emitter, '{');
            emit_key(emitter, "not");
            write_required(emitter, a->param.name, b->param.name);
            emit_close(emitter, '{');
        }
}

/* A section has at most one choice of which something must be given. */
static void write_demand(struct emitter *emitter, const struct schema_section *section)
{
    bool any = false;
    for (size_t i = 0; i < section->row_count; i++) {
        if (!section->rows[i].demanded)
            continue;
        if (!any) {
            emit_open(emitter, '{');
            emit_open_of(emitter, "anyOf", '[');
            any = true;
        }
        write_required(emitter, section->rows[i].param.name, NULL);
    }
    if (any) {
        emit_close(emitter, '[');
        emit_close(emitter, '{');
    }
}

/* A merge key may bring what is missing. */
static void write_rules(struct emitter *emitter, const struct schema_section *section)
{
    emit_raw_of(emitter, "if", "{\"type\": \"object\", \"not\": {\"required\": [\"<<\"]}}");
    emit_open_of(emitter, "then", '{');
    emit_open_of(emitter, "required", '[');
    for (size_t i = 0; i < section->row_count; i++)
        if (schema_is_required(&section->rows[i]))
            emit_text(emitter, section->rows[i].param.name);
    emit_close(emitter, '[');
    emit_open_of(emitter, "allOf", '[');
    emit_raw(emitter, "true");
    write_exclusions(emitter, section);
    write_demand(emitter, section);
    emit_close(emitter, '[');
    emit_close(emitter, '{');
}

static void write_section(struct emitter *emitter, const struct schema_section *section)
{
    char name[NAME_TEXT];
    section_name(section, name);
    emit_open_of(emitter, name, '{');
    emit_text_of(emitter, "description", section->summary);
    emit_raw_of(emitter, "type", "[\"object\", \"null\", \"string\"]");
    emit_raw_of(emitter, "pattern", "\"^=\"");
    emit_open_of(emitter, "properties", '{');
    for (size_t i = 0; i < section->row_count; i++)
        write_row(emitter, &section->rows[i]);
    emit_raw_of(emitter, "<<", "true");
    emit_close(emitter, '{');
    emit_raw_of(emitter, "additionalProperties", "false");
    write_rules(emitter, section);
    emit_close(emitter, '{');
}

/* {KIND: {...}}, of the kinds of a family; in lists, loops may stand in its place. */
static void write_family(struct emitter *emitter, const char *family)
{
    emit_open_of(emitter, family, '{');
    emit_raw_of(emitter, "if", "{\"$ref\": \"#/$defs/loop\"}");
    emit_raw_of(emitter, "then", "true");
    emit_open_of(emitter, "else", '{');
    emit_raw_of(emitter, "type", "[\"object\", \"string\"]");
    emit_raw_of(emitter, "pattern", "\"^=\"");
    emit_open_of(emitter, "properties", '{');
    for (size_t i = 0; i < schema_section_count(); i++) {
        char name[NAME_TEXT];
        const struct schema_section *section = schema_section(i);
        section_name(section, name);
        if (strcmp(section->family, family) != 0)
            continue;
        emit_key(emitter, section->name);
        schema_json_reference(emitter, name);
    }
    emit_close(emitter, '{');
    emit_raw_of(emitter, "additionalProperties", "false");
    emit_raw_of(emitter, "minProperties", "1");
    emit_raw_of(emitter, "maxProperties", "1");
    emit_close(emitter, '{');
    emit_close(emitter, '{');
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
static void write_common(struct emitter *emitter)
{
    emit_open_of(emitter, "formula", '{');
    emit_text_of(emitter, "type", "string");
    emit_text_of(emitter, "pattern", FORMULA);
    emit_close(emitter, '{');
    emit_raw_of(emitter, "text", "{\"type\": [\"string\", \"number\", \"boolean\"]}");
    emit_raw_of(emitter, "yes_or_no",
                "{\"enum\": [true, false, \"yes\", \"no\", \"on\", \"off\", \"true\", \"false\", "
                "0, 1]}");
    emit_raw_of(emitter, "loop",
                "{\"type\": \"object\", \"anyOf\": [{\"required\": [\"for\", \"do\"]}, "
                "{\"required\": [\"if\"]}]}");
    emit_raw_of(emitter, "repeated",
                "{\"description\": \"a list with loops\", \"type\": \"array\", "
                "\"contains\": {\"$ref\": \"#/$defs/loop\"}}");
    emit_raw_of(emitter, "strategy",
                "{\"anyOf\": [{\"type\": \"string\"}, {\"type\": \"object\", \"minProperties\": 1, "
                "\"maxProperties\": 1, \"additionalProperties\": {\"type\": [\"object\", "
                "\"null\", \"string\"]}}]}");
}

void schema_json_write(FILE *stream)
{
    struct emitter emitter = {.stream = stream};
    emit_open(&emitter, '{');
    emit_text_of(&emitter, "$schema", "https://json-schema.org/draft/2020-12/schema");
    emit_text_of(&emitter, "title", "scene of psplat (psd 1)");
    emit_raw_of(&emitter, "$ref", "\"#/$defs/scene\"");
    emit_open_of(&emitter, "$defs", '{');
    write_common(&emitter);
    for (size_t i = 0; i < schema_section_count(); i++) {
        if (is_first_of_family(i))
            write_family(&emitter, schema_section(i)->family);
        write_section(&emitter, schema_section(i));
    }
    emit_close(&emitter, '{');
    emit_close(&emitter, '{');
    fputc('\n', stream);
}
