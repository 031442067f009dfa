/* schema_json_value.c: see schema_json_value.h. */
#include "parser/schema/schema_json_value.h"

#include <math.h>

void schema_json_reference(struct emitter *emitter, const char *name)
{
    char text[128];
    snprintf(text, sizeof text, "#/$defs/%s", name);
    emit_open(emitter, '{');
    emit_text_of(emitter, "$ref", text);
    emit_close(emitter, '{');
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
    emit_text_of(emitter, "type",
                 param->type == PS_PARAM_INT || param->flags & PS_PARAM_WHOLE ? "integer"
                                                                              : "number");
    write_range(emitter, param);
    emit_close(emitter, '{');
}

/* A number or a formula of one. */
static void write_item(struct emitter *emitter, const ps_param *param)
{
    emit_open(emitter, '{');
    emit_open_of(emitter, "anyOf", '[');
    write_number(emitter, param);
    schema_json_reference(emitter, "formula");
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
        schema_json_reference(emitter, "yes_or_no");
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
        schema_json_reference(emitter, "text");
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
    schema_json_reference(emitter, "formula");
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
    schema_json_reference(emitter, name);
    emit_close(emitter, '{');
}

static void write_step(struct emitter *emitter, const char *family)
{
    emit_open(emitter, '{');
    emit_text_of(emitter, "type", "array");
    emit_open_of(emitter, "items", '{');
    emit_open_of(emitter, "allOf", '[');
    schema_json_reference(emitter, family);
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
        schema_json_reference(emitter, row->family);
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

void schema_json_alternatives(struct emitter *emitter, const struct schema_row *row)
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
        schema_json_reference(emitter, row->family);
        break;
    case SCHEMA_SCALAR_PIGMENT:
        write_plain(emitter, &number);
        schema_json_reference(emitter, row->family);
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
        schema_json_reference(emitter, "text");
        break;
    case SCHEMA_MATERIALS:
        write_many(emitter, "[\"object\", \"null\"]", "additionalProperties", "text");
        break;
    case SCHEMA_STRATEGY:
        schema_json_reference(emitter, "strategy");
        break;
    default:
        write_sections(emitter, row);
        break;
    }
}
