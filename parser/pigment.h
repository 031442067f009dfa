/* pigment.h: colours, or numbers, that may vary over a surface. */
#ifndef PARSER_PIGMENT_H
#define PARSER_PIGMENT_H

#include "parser/value.h"

/* A pigment of one colour, whatever it is. */
struct pigment_description pigment_of(ps_rgb color);

/* Reads a colour, or {kind: {...}}, into the pigment whose colors[0] is at the row's offset of the
 * state. Colours must be in the row's range. False where something was reported. */
bool pigment_read(struct reader *reader, struct subject subject, const struct schema_row *row,
                  const struct node *node, void *state);

#endif
