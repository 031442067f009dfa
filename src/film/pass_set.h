/* pass_set.h: which passes a film is the sum of.
 *
 * Runs of numbers, in order and apart, as "0:4,8:12": from the first of a run to before the second.
 */
#ifndef FILM_PASS_SET_H
#define FILM_PASS_SET_H

#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>

struct pass_run {
    uint32_t first, end;
};

/* Zero-initialise; owns its runs. */
struct pass_set {
    struct pass_run *runs;
    size_t count, capacity;
};

void pass_set_release(struct pass_set *set);

/* Adds the passes from `first` to before `end`, none of which may be there yet. */
ps_result pass_set_add(struct pass_set *set, uint32_t first, uint32_t end, struct error *error);

/* Adds all of another set, none of which may be there yet. */
ps_result pass_set_add_all(struct pass_set *set, const struct pass_set *other, struct error *error);

bool pass_set_has(const struct pass_set *set, uint32_t number);

/* Whether two sets have a pass in common; the first such in *number. */
bool pass_set_meets(const struct pass_set *a, const struct pass_set *b, uint32_t *number);

/* Whether both hold the same passes. */
bool pass_set_same(const struct pass_set *a, const struct pass_set *b);

/* The first number from `first` on that is not there. */
uint32_t pass_set_next_missing(const struct pass_set *set, uint32_t first);

uint32_t pass_set_size(const struct pass_set *set);
uint32_t pass_set_odd_size(const struct pass_set *set); /* of the odd numbers */

/* "0:4,8:12"; the caller frees it; NULL when out of memory. */
char *pass_set_format(const struct pass_set *set);

/* The other way, into an empty set. PS_ERROR_INVALID where the text is no such list. */
ps_result pass_set_parse(const char *text, struct pass_set *set, struct error *error);

#endif
