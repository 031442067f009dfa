/* lexer.h: cuts the text of a pbrt scene into tokens.
 *
 * Words (directives, true, false), numbers, strings in double quotes with the escapes of C, and
 * brackets; # starts a comment up to the end of its line (pbrt-v4 file format, "Tokenization").
 * Lines and columns count from 1, columns in characters of UTF-8.
 */
#ifndef PBRT_LEXER_H
#define PBRT_LEXER_H

#include "base/origin.h"
#include <stdbool.h>
#include <stddef.h>

enum token_kind {
    TOKEN_END,
    TOKEN_WORD,
    TOKEN_NUMBER,
    TOKEN_STRING,
    TOKEN_OPEN,  /* [ */
    TOKEN_CLOSE, /* ] */
    TOKEN_BAD    /* `text` says what is wrong, and begins in lower case */
};

struct token {
    enum token_kind kind;
    /* Of words, strings (without quotes and escapes) and bad tokens: until the next token. */
    const char *text;
    double number;
    struct origin origin;
    int width; /* in characters, as written */
};

/* Zeroed: empty. The text must outlive it. */
struct lexer {
    const char *at, *end;
    const char *file; /* for origins */
    int line, column;
    char *text; /* owned: the latest token's */
    size_t text_size;
};

/* Strings are UTF-8; a byte order mark before the first token is skipped. `file` must outlive every
 * origin. */
struct lexer lexer_start(const char *file, const char *text, size_t length);
struct token lexer_next(struct lexer *lexer);
void lexer_release(struct lexer *lexer);

#endif
