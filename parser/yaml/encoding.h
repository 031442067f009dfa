/* encoding.h: UTF-8 and line breaks as YAML 1.1 counts them.
 *
 * Positions in messages count characters, not bytes, and lines end at CR, LF, CR LF, U+0085,
 * U+2028 and U+2029, as in libyaml's marks.
 */
#ifndef PARSER_YAML_ENCODING_H
#define PARSER_YAML_ENCODING_H

#include "parser/yaml/diagnostic.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads one character; returns how many bytes it takes, or 0 where they are no UTF-8. */
size_t utf8_decode(const char *text, size_t length, uint32_t *code);

/* Whether all of it is UTF-8. */
bool utf8_is_valid(const char *text, size_t length);

/* Bytes of the line break that the text starts with, or 0. */
size_t line_break_length(const char *text, size_t length);

/* Moves a position, from 1, from where the text starts to where it ends. */
void encoding_advance(const char *text, size_t length, int *line, int *column);

/* Bytes of the byte order mark that the text starts with: 3 or 0. */
size_t byte_order_mark_length(const char *text, size_t length);

/* Reports the first thing that makes the text unfit for libyaml: bytes that are not UTF-8,
 * characters that YAML forbids (NUL among them), or a crowd of directives. */
ps_result encoding_check(const char *file, const char *text, size_t length,
                         struct diagnostics *sink);

#endif
