/* placement.h: from the keys of transforms to an affine map. */
#ifndef PARSER_PLACEMENT_H
#define PARSER_PLACEMENT_H

#include "parser/keys.h"
#include "parser/reader.h"

/* Makes of what was filled from the map, whose key is `at`, a map that has an inverse; false where
 * something was reported. */
bool placement_read(struct reader *reader, const struct node *at, const struct node *map,
                    const struct placement_keys *keys, struct affine *placement);

/* Whether the map has an inverse, of numbers that floats can hold. */
bool placement_is_regular(const struct affine *map);

#endif
