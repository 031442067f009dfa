/* schema_json_value.h: what a value of the scene language may be, in JSON Schema. */
#ifndef PARSER_SCHEMA_SCHEMA_JSON_VALUE_H
#define PARSER_SCHEMA_SCHEMA_JSON_VALUE_H

#include "base/json_writer.h"
#include "parser/schema/schema.h"

/* {"$ref": "#/$defs/NAME"} */
void schema_json_reference(struct json_writer *writer, const char *name);

/* The schemas of which the row's value fits one, but for formulas and lists with loops. */
void schema_json_alternatives(struct json_writer *writer, const struct schema_row *row);

#endif
