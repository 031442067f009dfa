/* fill.h: fills states from maps by the tables of schema.h. */
#ifndef PARSER_SECTIONS_FILL_H
#define PARSER_SECTIONS_FILL_H

#include "parser/schema/schema.h"
#include "parser/sections/reader.h"

/* Fills `state`, which must be zeroed, with the section's defaults and what the map says. `at` is
 * the key that the section stands under, for what is missing. False where something was reported.
 * A node without a value counts as an empty map. Values that hold sections stay with the caller. */
bool fill_section(struct reader *reader, const struct schema_section *section,
                  const struct node *at, const struct node *map, void *state);

/* Whether the node is a list (or map), or nothing, which counts as an empty one; else reports
 * that `name` must be one. */
bool fill_expect(const struct reader *reader, const char *name, const struct node *node,
                 enum node_kind kind);

/* The section that an item of a list, or a pattern, names: `node` is a map of one key,
 * `{spotlight: {...}}`, of the family. NULL where something was reported; `name` is the key that
 * the item stands under. */
const struct schema_section *fill_find_kind(const struct reader *reader, const char *family,
                                            const char *name, const struct node *node);

#endif
