/* schema_json.h: the scene language as JSON Schema (draft 2020-12), for editors.
 *
 * YAML that psplat accepts is valid, and what the tables can say to be wrong is not; the rest
 * (names that are not defined, shapes without a size) only psplat finds. Formulas, and anything
 * that loops may make, are taken as they stand. Readers of YAML 1.2 may be used as well as those of
 * 1.1.
 */
#ifndef PARSER_SCHEMA_SCHEMA_JSON_H
#define PARSER_SCHEMA_SCHEMA_JSON_H

#include <stdio.h>

/* Writes all of it; errors of the stream are the caller's to find. */
void schema_json_write(FILE *stream);

#endif
