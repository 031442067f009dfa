/* format.h: lays out the text of a scene, or of a file that scenes include, as those that psplat
 * ships are. */
#ifndef PARSER_FORMAT_H
#define PARSER_FORMAT_H

#include "parser/yaml/diagnostic.h"

/* Comments, order and meaning stay; layout.h has the rules. A byte order mark goes. The text that
 * is returned is to be freed. PS_ERROR_INVALID: it is no YAML that psplat reads, which is reported;
 * what its keys mean is not looked at. PS_ERROR_MEMORY. `name` stands for the file in messages. */
ps_result psd_format_text(const char *name, const char *text, size_t length,
                          struct diagnostics *sink, char **formatted, size_t *formatted_length);

#endif
