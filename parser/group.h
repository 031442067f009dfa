/* group.h: objects by name, and their instances.
 *
 * A description's groups hold no instances: those that the file has in a group are resolved into
 * copies, and groups that contain themselves are errors.
 */
#ifndef PARSER_GROUP_H
#define PARSER_GROUP_H

#include "parser/object.h"

/* Adds the groups to the description, and their names to the reader. */
void groups_read(struct reader *reader, const struct node *root);

/* Reads an instance: an object of the file, or copies of objects in a group. */
void group_instance(struct reader *reader, const struct item *item, const struct object_keys *keys,
                    const struct object_context *context);

#endif
