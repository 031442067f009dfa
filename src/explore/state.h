/* state.h: what a page shows beside pictures, as JSON: views, how far they are, and what is
 * wrong. */
#ifndef EXPLORE_STATE_H
#define EXPLORE_STATE_H

#include <stdint.h>

struct explorer;

/* In one line, to be freed; NULL when out of memory. `serial`: of what it tells. */
char *state_write(struct explorer *explorer, uint64_t *serial);

/* The views' histories, likewise: lists of {"passes", "cpu_seconds", "error"}. */
char *state_write_history(struct explorer *explorer);

#endif
