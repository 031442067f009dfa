/* check.h: parts of the checks that no table can say: how the values of one section must fit
 * together.
 *
 * Each section's reader has its own, for a map that was filled without errors.
 */
#ifndef PARSER_SECTIONS_CHECK_H
#define PARSER_SECTIONS_CHECK_H

#include "parser/sections/reader.h"

/* Reports the message at the node where `good` is false; returns `good`. */
bool check_expect(const struct reader *reader, bool good, const struct node *at,
                  const char *message);

/* The value under the key, where a message points; `at` where the map has no such key. */
const struct node *check_value(const struct node *map, const struct node *at, const char *key);

bool check_zero(ps_vec3 v);

/* Whether `up` is along the way from one point to the other. */
bool check_up_along(ps_vec3 from, ps_vec3 to, ps_vec3 up);

/* The vector's direction, of length 1, however long or short it is; 0 of 0. */
ps_vec3 check_unit(ps_vec3 v);

#endif
