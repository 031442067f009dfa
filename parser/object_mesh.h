/* object_mesh.h: mesh files as objects. */
#ifndef PARSER_OBJECT_MESH_H
#define PARSER_OBJECT_MESH_H

#include "parser/object.h"

/* Reads the file that the keys name, and adds what is used of it to the description. */
void object_mesh_read(struct reader *reader, const struct item *item,
                      const struct object_keys *keys, const struct object_context *context);

#endif
