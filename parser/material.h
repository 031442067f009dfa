/* material.h: the section of materials. */
#ifndef PARSER_MATERIAL_H
#define PARSER_MATERIAL_H

#include "parser/reader.h"

/* Adds the materials to the description, and their names to the reader. */
void materials_read(struct reader *reader, const struct node *root);

#endif
