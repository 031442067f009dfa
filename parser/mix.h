/* mix.h: materials that are mixed from others. */
#ifndef PARSER_MIX_H
#define PARSER_MIX_H

#include "parser/reader.h"

/* Reads the components of a mix; false where something was reported. */
bool mix_read(struct reader *reader, const struct item *item,
              struct material_description *material);

/* Orders the description's materials so that components come before what is mixed from them; others
 * keep their order. Reports mixes that contain themselves. */
void mix_order(struct reader *reader);

#endif
