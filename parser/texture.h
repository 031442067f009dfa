/* texture.h: pictures that the scene names. */
#ifndef PARSER_TEXTURE_H
#define PARSER_TEXTURE_H

#include "parser/keys.h"
#include "parser/reader.h"

/* Adds a texture to the description, once for each way in which a file is used. Returns its index,
 * or NO_INDEX where memory ran out, which is noted. */
size_t texture_add(struct reader *reader, const struct texture_keys *keys);

#endif
