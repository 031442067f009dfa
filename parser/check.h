/* check.h: what no table can say: how the values of one section must fit together.
 *
 * Each check is for a section that was filled without errors. `map` is the section, where the
 * messages point; its key `at` stands in for a key that is absent.
 */
#ifndef PARSER_CHECK_H
#define PARSER_CHECK_H

#include "parser/reader.h"

void check_camera(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct camera_description *camera);
void check_light(const struct reader *reader, const struct node *at, const struct node *map,
                 const struct light_description *light);
void check_object(const struct reader *reader, const struct node *at, const struct node *map,
                  const struct object_description *object);

#endif
