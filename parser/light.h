/* light.h: the section of lights. */
#ifndef PARSER_LIGHT_H
#define PARSER_LIGHT_H

#include "parser/reader.h"

/* Adds the lights to the description. */
void lights_read(struct reader *reader, const struct node *root);

#endif
