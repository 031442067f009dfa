/* catalogue.h: what can be set, from the tables that `psplat plugins` and the scene language have,
 * as JSON. */
#ifndef EXPLORE_CATALOGUE_H
#define EXPLORE_CATALOGUE_H

#include "base/error.h"

struct explorer;

/* The kinds of strategy with their plugins and these with their parameters: a list, to be freed. It
 * stays the same as long as the program runs. */
ps_result catalogue_kinds(char **text, struct error *error);

/* The whole: version, scene, kinds, options, the scene's parameters and cameras; to be freed. Reads
 * the scene's text. NULL when out of memory. */
char *catalogue_write(struct explorer *explorer);

#endif
