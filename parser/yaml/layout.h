/* layout.h: lays out a YAML text as scenes are written by hand.
 *
 * Blocks are indented by two columns, lists in maps too; one blank follows colons, commas and
 * dashes, and none stands inside of brackets and braces or before commas and colons. No line is
 * broken or joined, so that the writer's own arrangement stays. Comments move with the lines that
 * they belong to, and those behind a line keep their column where more than one blank stands before
 * them. Lines of texts of several lines move as a whole. Several empty lines become one, those at
 * the start and the end of the text go, and so do blanks at the ends of lines.
 */
#ifndef PARSER_YAML_LAYOUT_H
#define PARSER_YAML_LAYOUT_H

#include "base/error.h"
#include <stddef.h>

/* The laid out text of one that document_read takes; to be freed. Where it would mean something
 * else, which rare forms of YAML may cause, it is the text as it was. PS_ERROR_INVALID: it is not
 * YAML; PS_ERROR_MEMORY. */
ps_result layout_text(const char *text, size_t length, char **laid_out, size_t *laid_out_length);

#endif
