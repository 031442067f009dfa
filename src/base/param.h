/* param.h: values in text form, checked against parameter tables (see psplat/param.h).
 *
 * One parser serves scene files, `--plugin` and defaults, so a value means the same wherever it is
 * written. Numbers are read without the locale. Vectors and colours are "[x, y, z]"; a colour may
 * be one number, meaning grey.
 */
#ifndef BASE_PARAM_H
#define BASE_PARAM_H

#include "base/error.h"
#include "base/suggestion.h"
#include <psplat/param.h>

/* Rows of `count` parameters, `stride` bytes apart (a plugin may have been built with more
 * members). */
struct param_table {
    const ps_param *rows;
    size_t count;
    size_t stride;
};

const ps_param *param_row(const struct param_table *table, size_t index);

/* NULL where the table has no such name. */
const ps_param *param_find(const struct param_table *table, const char *name);

/* The name in the table that `name` most likely meant. */
struct suggestion param_suggest(const struct param_table *table, const char *name);

/* Parses `text` for `row` and stores it in `state`. PS_ERROR_INVALID with a message such as
 * "expected a number above 0, got 'x'". A stored string is a copy that param_release frees. On an
 * error the state is unchanged. */
ps_result param_set(const ps_param *row, void *state, const char *text, struct error *error);

/* Sets every parameter that has a default; `state` must be zeroed. Whole numbers of samples
 * (PS_PARAM_QUALITY) are multiplied by `effort`, within what the row allows. */
ps_result param_set_defaults(const struct param_table *table, void *state, double effort,
                             struct error *error);

/* Frees the strings that param_set stored. */
void param_release(const struct param_table *table, void *state);

/* Writes the value in the state as text that param_set reads back to the same value. */
void param_format(const ps_param *row, const void *state, char *text, size_t size);

/* "number > 0", "integer 1..64", "auto | full | number >= 0", ... */
void param_describe_domain(const ps_param *row, char *text, size_t size);

#endif
