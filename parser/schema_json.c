/* schema_json.c: see schema_json.h. One definition for each section, each family of several sections,
 * and what many values have in common.
 */
#include "parser/schema_json.h"

#include "base/text.h"
#include "parser/emit.h"
#include "parser/schema.h"
#include <math.h>
#include <string.h>

/* A formula; and numbers such as 1e6, which are text to some readers of YAML 1.1. */
#define FORMULA "^(=.*|[+-]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][+-]?[0-9]+)?)$"

#define NAME_TEXT 80

static void write_reference(struct emitter *emitter, const char *name)
{
    char text[NAME_TEXT + 16];
    snprintf(text, sizeof text, "#/$defs/%s", name);
    emit_open(emitter, '{');
    emit_text_of(emitter, "$ref", text);
    emit_close(emitter, '{');
}

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

static void write_range(struct emitter *emitter, const ps_param *param)
{
    if (isfinite(param->minimum))
        emit_number_of(emitter, param->flags & PS_PARAM_OPEN_MIN ? "exclusiveMinimum" : "minimum",
                       param->minimum);
    if (isfinite(param->maximum))
        emit_number_of(emitter, param->flags & PS_PARAM_OPEN_MAX ? "exclusiveMaximum" : "maximum",
                       param->maximum);
}

static void write_number(struct emitter *emitter, const ps_param *param)
{
    emit_open(emitter, '{');
    emit_text_of(emitter, "type", param->type == PS_PARAM_INT ? "integer" : "number");
    write_range(emitter, param);
    emit_close(emitter, '{');
}

/* A number or a formula of one. */
static void write_item(struct emitter *emitter, const ps_param *param)
{
    emit_open(emitter, '{');
    emit_open_of(emitter, "anyOf", '[');
    write_number(emitter, param);
    write_reference(emitter, "formula");
    emit_close(emitter, '[');
    emit_close(emitter, '{');
}

/* A list of so many numbers in the range of the row. */
static void write_numbers(struct emitter *emitter, const ps_param *param, int count)
{
    emit_open(emitter, '{');
    emit_text_of(emitter, "type", "array");
    emit_key(emitter, "items");
    write_item(emitter, param);
    emit_number_of(emitter, "minItems", count);
    emit_number_of(emitter, "maxItems", count);
    emit_close(emitter, '{');
}

static void write_choices(struct emitter *emitter, const char *const *choices)
{
    emit_open(emitter, '{');
    emit_open_of(emitter, "enum", '[');
    for (size_t i = 0; choices[i]; i++)
        emit_text(emitter, choices[i]);
    emit_close(emitter, '[');
    emit_close(emitter, '{');
}

/* The alternatives of a value that its ps_param says all about. */
static void write_plain(struct emitter *emitter, const ps_param *param)
{
    switch ((ps_param_type)param->type) {
    case PS_PARAM_BOOL:
        write_reference(emitter, "yes_or_no");
        break;
    case PS_PARAM_INT:
    case PS_PARAM_NUMBER:
        write_number(emitter, param);
        break;
    case PS_PARAM_COLOR:
        write_number(emitter, param);
        write_numbers(emitter, param, 3);
        break;
    case PS_PARAM_VEC3:
        write_numbers(emitter, param, 3);
        break;
    case PS_PARAM_STRING:
        write_reference(emitter, "text");
        break;
    case PS_PARAM_NUMBER_OR_CHOICE:
        write_number(emitter, param);
        write_choices(emitter, param->choices);
        break;
    case PS_PARAM_CHOICE:
        write_choices(emitter, param->choices);
        break;
    }
}

/* What stands in a list: one of the row's points, triangles, words, ... */
static void write_element(struct emitter *emitter, const struct schema_row *row)
{
    const ps_param index = {.type = PS_PARAM_INT, .minimum = 0, .maximum = INFINITY};
    emit_open(emitter, '{');
    emit_open_of(emitter, "anyOf", '[');
    if (row->form == SCHEMA_POINTS || row->form == SCHEMA_COLORS || row->form == SCHEMA_MATRIX)
        write_plain(emitter, &row->param);
    else if (row->form == SCHEMA_TRIANGLES)
        write_numbers(emitter, &index, 3);
    else if (row->form == SCHEMA_PAIRS)
        write_numbers(emitter, &row->param, 2);
    else
        write_choices(emitter, row->param.choices);
    write_reference(emitter, "formula");
    emit_close(emitter, '[');
    emit_close(emitter, '{');
}

static void write_list(struct emitter *emitter, const struct schema_row *row)
{
    emit_open(emitter, '{');
    emit_text_of(emitter, "type", "array");
    emit_key(emitter, "items");
    write_element(emitter, row);
    emit_number_of(emitter, "minItems", (double)row->fewest);
    if (row->most != SIZE_MAX)
        emit_number_of(emitter, "maxItems", (double)row->most);
    emit_close(emitter, '{');
}

/* A map from any name, or a list, of what the family is; sections may be left empty. */
static void write_many(struct emitter *emitter, const char *type, const char *items,
                       const char *name)
{
    emit_open(emitter, '{');
    emit_raw_of(emitter, "type", type);
    emit_key(emitter, items);
    write_reference(emitter, name);
    emit_close(emitter, '{');
}

static void write_step(struct emitter *emitter, const char *family)
{
    emit_open(emitter, '{');
    emit_text_of(emitter, "type", "array");
    emit_open_of(emitter, "items", '{');
    emit_open_of(emitter, "allOf", '[');
    write_reference(emitter, family);
    emit_raw(emitter, "{\"maxProperties\": 1}");
    emit_close(emitter, '[');
    emit_close(emitter, '{');
    emit_close(emitter, '{');
}

static void write_named_lists(struct emitter *emitter, const char *family)
{
    emit_open(emitter, '{');
    emit_raw_of(emitter, "type", "[\"object\", \"null\"]");
    emit_key(emitter, "additionalProperties");
    write_many(emitter, "[\"array\", \"null\"]", "items", family);
    emit_close(emitter, '{');
}

/* The alternatives of a value that holds sections. */
static void write_sections(struct emitter *emitter, const struct schema_row *row)
{
    switch (row->form) {
    case SCHEMA_MAP:
        write_reference(emitter, row->family);
        break;
    case SCHEMA_NAMED:
        write_many(emitter, "[\"object\", \"null\"]", "additionalProperties", row->family);
        break;
    case SCHEMA_ITEMS:
    case SCHEMA_LIST:
        write_many(emitter, "[\"array\", \"null\"]", "items", row->family);
        break;
    case SCHEMA_STEPS:
        write_step(emitter, row->family);
        break;
    case SCHEMA_NAMED_LISTS:
        write_named_lists(emitter, row->family);
        break;
    default:
        emit_raw(emitter, "true");
        break;
    }
}

static void write_alternatives(struct emitter *emitter, const struct schema_row *row)
{
    const ps_param *param = &row->param;
    ps_param number = *param;
    number.type = PS_PARAM_NUMBER;
    switch (row->form) {
    case SCHEMA_VALUE:
        write_plain(emitter, param);
        break;
    case SCHEMA_SCALE:
    case SCHEMA_PAIR:
        write_number(emitter, &number);
        write_numbers(emitter, &number, row->form == SCHEMA_PAIR ? 2 : 3);
        break;
    case SCHEMA_PIGMENT:
        write_plain(emitter, param);
        write_reference(emitter, row->family);
        break;
    case SCHEMA_SCALAR_PIGMENT:
        write_plain(emitter, &number);
        write_reference(emitter, row->family);
        break;
    case SCHEMA_MATRIX:
    case SCHEMA_WORDS:
    case SCHEMA_POINTS:
    case SCHEMA_PAIRS:
    case SCHEMA_TRIANGLES:
    case SCHEMA_COLORS:
        write_list(emitter, row);
        break;
    case SCHEMA_MATERIAL:
    case SCHEMA_GROUP:
    case SCHEMA_FILE:
        write_reference(emitter, "text");
        break;
    case SCHEMA_MATERIALS:
        write_many(emitter, "[\"object\", \"null\"]", "additionalProperties", "text");
        break;
    case SCHEMA_STRATEGY:
        write_reference(emitter, "strategy");
        break;
    default:
        write_sections(emitter, row);
        break;
    }
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
    write_alternatives(emitter, row);
    write_reference(emitter, "formula");
    write_reference(emitter, "repeated");
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
        write_reference(emitter, name);
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
