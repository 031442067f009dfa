/* check.h: what no table can say: how the values of one section must fit together.
 *
 * Each check is for a section that was filled without errors. `map` is the section, where the
 * messages point; its key `at` stands in for a key that is absent. False where something was
 * reported.
 */
#ifndef PARSER_SECTIONS_CHECK_H
#define PARSER_SECTIONS_CHECK_H

#include "parser/schema/keys.h"
#include "parser/sections/reader.h"

bool check_camera(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct camera_description *camera);
bool check_light(const struct reader *reader, const struct node *at, const struct node *map,
                 const struct light_description *light);
bool check_object(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct object_keys *keys);

/* Of the section under the item. */
bool check_look_at(const struct reader *reader, const struct item *item,
                   const struct look_at_keys *keys);

/* The vector's direction, of length 1, however long or short it is; 0 of 0. */
ps_vec3 check_unit(ps_vec3 v);

#endif
