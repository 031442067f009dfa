/* tokens.h: the tokens of a YAML text, with their places in it: what a formatter needs and a tree
 * has forgotten. */
#ifndef PARSER_YAML_TOKENS_H
#define PARSER_YAML_TOKENS_H

#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>

/* `type` is libyaml's yaml_token_type_t. Those that stand for no text, such as a block's start, are
 * empty. */
struct token {
    int type;
    size_t start, end;         /* bytes */
    size_t column, end_column; /* characters, from 0 */
};

/* Of a text that document_read takes. The tokens are to be freed. PS_ERROR_INVALID,
 * PS_ERROR_MEMORY. */
ps_result tokens_scan(const char *text, size_t length, struct token **tokens, size_t *count);

/* Whether two texts hold the same: the same values, keys, anchors and tags in one order, and the
 * same characters but for blanks and line breaks between them, comments among those. */
bool tokens_same_meaning(const char *a, size_t a_length, const char *b, size_t b_length);

#endif
