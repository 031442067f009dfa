/* schema_json_value.c: see schema_json_value.h. */
#include "parser/schema/schema_json_value.h"

#include "parser/schema/keys.h"

#include <math.h>

void schema_json_reference(struct json_writer *writer, const char *name)
{
    char text[128];
    snprintf(text, sizeof text, "#/$defs/%s", name);
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "$ref", text);
    json_writer_close(writer, '{');
}

static void write_range(struct json_writer *writer, const ps_param *param)
{
    if (isfinite(param->minimum))
        json_writer_number_of(writer,
                              param->flags & PS_PARAM_OPEN_MIN ? "exclusiveMinimum" : "minimum",
                              param->minimum);
    if (isfinite(param->maximum))
        json_writer_number_of(writer,
                              param->flags & PS_PARAM_OPEN_MAX ? "exclusiveMaximum" : "maximum",
                              param->maximum);
}

static void write_number(struct json_writer *writer, const ps_param *param)
{
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "type",
                        param->type == PS_PARAM_INT || param->flags & PS_PARAM_WHOLE ? "integer"
                                                                                     : "number");
    write_range(writer, param);
    json_writer_close(writer, '{');
}

/* A number or a formula of one. */
static void write_item(struct json_writer *writer, const ps_param *param)
{
    json_writer_open(writer, '{');
    json_writer_open_of(writer, "anyOf", '[');
    write_number(writer, param);
    schema_json_reference(writer, "formula");
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
}

/* A list of so many numbers in the range of the row. */
static void write_numbers(struct json_writer *writer, const ps_param *param, int count)
{
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "type", "array");
    json_writer_key(writer, "items");
    write_item(writer, param);
    json_writer_number_of(writer, "minItems", count);
    json_writer_number_of(writer, "maxItems", count);
    json_writer_close(writer, '{');
}

static void write_choices(struct json_writer *writer, const char *const *choices)
{
    json_writer_open(writer, '{');
    json_writer_open_of(writer, "enum", '[');
    for (size_t i = 0; choices[i]; i++)
        json_writer_text(writer, choices[i]);
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
}

/* The alternatives of a value that its ps_param says all about. */
static void write_plain(struct json_writer *writer, const ps_param *param)
{
    switch ((ps_param_type)param->type) {
    case PS_PARAM_BOOL:
        schema_json_reference(writer, "yes_or_no");
        break;
    case PS_PARAM_INT:
    case PS_PARAM_NUMBER:
        write_number(writer, param);
        break;
    case PS_PARAM_COLOR:
        write_number(writer, param);
        write_numbers(writer, param, 3);
        break;
    case PS_PARAM_VEC3:
        write_numbers(writer, param, 3);
        break;
    case PS_PARAM_STRING:
        schema_json_reference(writer, "text");
        break;
    case PS_PARAM_NUMBER_OR_CHOICE:
        write_number(writer, param);
        write_choices(writer, param->choices);
        break;
    case PS_PARAM_CHOICE:
        write_choices(writer, param->choices);
        break;
    }
}

/* What stands in a list: one of the row's points, triangles, words, ... */
static void write_element(struct json_writer *writer, const struct schema_row *row)
{
    const ps_param index = {.type = PS_PARAM_INT, .minimum = 0, .maximum = INFINITY};
    json_writer_open(writer, '{');
    json_writer_open_of(writer, "anyOf", '[');
    if (row->form == SCHEMA_POINTS || row->form == SCHEMA_COLORS || row->form == SCHEMA_MATRIX)
        write_plain(writer, &row->param);
    else if (row->form == SCHEMA_TRIANGLES)
        write_numbers(writer, &index, 3);
    else if (row->form == SCHEMA_PAIRS)
        write_numbers(writer, &row->param, 2);
    else
        write_choices(writer, row->param.choices);
    schema_json_reference(writer, "formula");
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
}

static void write_list(struct json_writer *writer, const struct schema_row *row)
{
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "type", "array");
    json_writer_key(writer, "items");
    write_element(writer, row);
    json_writer_number_of(writer, "minItems", (double)row->fewest);
    if (row->most != SIZE_MAX)
        json_writer_number_of(writer, "maxItems", (double)row->most);
    json_writer_close(writer, '{');
}

/* A map from any name, or a list, of what the family is; sections may be left empty. */
static void write_many(struct json_writer *writer, const char *type, const char *items,
                       const char *name)
{
    json_writer_open(writer, '{');
    json_writer_raw_of(writer, "type", type);
    json_writer_key(writer, items);
    schema_json_reference(writer, name);
    json_writer_close(writer, '{');
}

static void write_step(struct json_writer *writer, const char *family)
{
    json_writer_open(writer, '{');
    json_writer_text_of(writer, "type", "array");
    json_writer_open_of(writer, "items", '{');
    json_writer_open_of(writer, "allOf", '[');
    schema_json_reference(writer, family);
    json_writer_raw(writer, "{\"maxProperties\": 1}");
    json_writer_close(writer, '[');
    json_writer_close(writer, '{');
    json_writer_close(writer, '{');
}

static void write_named_lists(struct json_writer *writer, const char *family)
{
    json_writer_open(writer, '{');
    json_writer_raw_of(writer, "type", "[\"object\", \"null\"]");
    json_writer_key(writer, "additionalProperties");
    write_many(writer, "[\"array\", \"null\"]", "items", family);
    json_writer_close(writer, '{');
}

/* The alternatives of a value that holds sections. */
static void write_sections(struct json_writer *writer, const struct schema_row *row)
{
    switch (row->form) {
    case SCHEMA_MAP:
        schema_json_reference(writer, row->family);
        break;
    case SCHEMA_NAMED:
        write_many(writer, "[\"object\", \"null\"]", "additionalProperties", row->family);
        break;
    case SCHEMA_ITEMS:
    case SCHEMA_LIST:
        write_many(writer, "[\"array\", \"null\"]", "items", row->family);
        break;
    case SCHEMA_STEPS:
        write_step(writer, row->family);
        break;
    case SCHEMA_NAMED_LISTS:
        write_named_lists(writer, row->family);
        break;
    default:
        json_writer_raw(writer, "true");
        break;
    }
}

void schema_json_alternatives(struct json_writer *writer, const struct schema_row *row)
{
    static const char *const places[] = {AUTO_WORD, NULL};
    const ps_param *param = &row->param;
    ps_param number = *param;
    number.type = PS_PARAM_NUMBER;
    switch (row->form) {
    case SCHEMA_VALUE:
        write_plain(writer, param);
        break;
    case SCHEMA_SCALE:
    case SCHEMA_PAIR:
        write_number(writer, &number);
        write_numbers(writer, &number, row->form == SCHEMA_PAIR ? 2 : 3);
        break;
    case SCHEMA_POINT_OR_AUTO:
        write_choices(writer, places);
        write_numbers(writer, param, 3);
        break;
    case SCHEMA_PIGMENT:
        write_plain(writer, param);
        schema_json_reference(writer, row->family);
        break;
    case SCHEMA_SCALAR_PIGMENT:
        write_plain(writer, &number);
        schema_json_reference(writer, row->family);
        break;
    case SCHEMA_MATRIX:
    case SCHEMA_WORDS:
    case SCHEMA_POINTS:
    case SCHEMA_PAIRS:
    case SCHEMA_TRIANGLES:
    case SCHEMA_COLORS:
        write_list(writer, row);
        break;
    case SCHEMA_MATERIAL:
    case SCHEMA_GROUP:
    case SCHEMA_FILE:
    case SCHEMA_LAYER:
        schema_json_reference(writer, "text");
        break;
    case SCHEMA_MATERIALS:
        write_many(writer, "[\"object\", \"null\"]", "additionalProperties", "text");
        break;
    case SCHEMA_STRATEGY:
        schema_json_reference(writer, "strategy");
        break;
    default:
        write_sections(writer, row);
        break;
    }
}
