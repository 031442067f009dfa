/* quote.h: texts as double-quoted scalars of YAML. */
#ifndef PARSER_YAML_QUOTE_H
#define PARSER_YAML_QUOTE_H

#include <stdio.h>

/* Writes the text, which is UTF-8 (utf8_is_valid), in quotes, with escapes for what may not
 * stand there as it is: quotes, controls, breaks of lines, marks of byte order. It reads back as
 * it was. */
void yaml_quote(FILE *stream, const char *text);

#endif
