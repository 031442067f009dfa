/* tokens.h: the text of a POV-Ray file as a list of tokens.
 *
 * A file is cut once and whole: loops and macros go back to a place in the list. Comments of C
 * nest, as POV-Ray has them. Texts that are no UTF-8 are taken for Latin-1. Lines and columns count
 * from 1, columns in characters.
 */
#ifndef POV_TOKENS_H
#define POV_TOKENS_H

#include "base/arena.h"
#include "pov/words.h"
#include <stdint.h>

enum pov_token_kind {
    POV_END,
    POV_WORD,
    POV_NUMBER,
    POV_STRING,
    POV_DIRECTIVE, /* a word behind # */
    POV_SYMBOL,    /* a character, or one of the codes below */
    POV_BAD        /* `text` says what is wrong, and begins in lower case */
};

enum pov_symbol { POV_LESS_EQUAL = 256, POV_GREATER_EQUAL, POV_NOT_EQUAL };

struct pov_token {
    uint16_t kind, width; /* width: in characters */
    uint32_t line, column;
    union {
        uint32_t word;
        uint32_t symbol;
        double number;
        const char *text;
    };
};

/* Ends with POV_END. */
struct pov_tokens {
    const char *file; /* for messages */
    char *folder;     /* owned; "" or ending in a slash */
    uint64_t device, serial;
    struct pov_token *list; /* owned */
    size_t count, capacity;
};

/* Cuts a text; words and texts go to the arena. False: out of memory, or there are more than `most`
 * tokens: then there are as many. `file` must outlive the tokens. */
bool pov_tokens_cut(struct pov_tokens *tokens, const char *file, const char *text, size_t length,
                    size_t most, struct pov_words *words, struct arena *arena);
void pov_tokens_release(struct pov_tokens *tokens);

#endif
