/* lexer.c: see lexer.h. */
#include "pbrt/lexer.h"

#include "base/text.h"
#include "parser/yaml/encoding.h"
#include <stdlib.h>
#include <string.h>

struct lexer lexer_start(const char *file, const char *text, size_t length)
{
    size_t mark = byte_order_mark_length(text, length);
    const char *end = length > 0 ? text + length : text; /* of nothing there may be no pointer */
    return (struct lexer){
        .at = mark ? text + mark : text, .end = end, .file = file, .line = 1, .column = 1};
}

void lexer_release(struct lexer *lexer)
{
    free(lexer->text);
    lexer->text = NULL;
}

/* Bytes 10xxxxxx go on with a character of UTF-8. */
static void advance(struct lexer *lexer)
{
    unsigned char byte = (unsigned char)*lexer->at++;
    if (byte == '\n') {
        lexer->line++;
        lexer->column = 1;
    } else if ((byte & 0xc0) != 0x80) {
        lexer->column++;
    }
}

static void skip_space(struct lexer *lexer)
{
    while (lexer->at < lexer->end) {
        char c = *lexer->at;
        if (c == '#')
            while (lexer->at < lexer->end && *lexer->at != '\n')
                advance(lexer);
        else if (c == ' ' || c == '\t' || c == '\n' || c == '\r')
            advance(lexer);
        else
            break;
    }
}

static bool ends_word(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '[' || c == ']' || c == '"' ||
           c == '#';
}

static struct token bad(struct token token, const char *why)
{
    token.kind = TOKEN_BAD;
    token.text = why;
    return token;
}

/* Room for `length` bytes and a terminator. */
static bool reserve(struct lexer *lexer, size_t length)
{
    if (length < lexer->text_size)
        return true;
    size_t wanted = 2 * length + 64;
    char *grown = realloc(lexer->text, wanted);
    if (!grown)
        return false;
    lexer->text = grown;
    lexer->text_size = wanted;
    return true;
}

/* What stands for an escape such as \n; 0: none. */
static char escaped(char c)
{
    static const char letters[] = "bfnrt\\'\"", meanings[] = "\b\f\n\r\t\\'\"";
    const char *found = c ? strchr(letters, c) : NULL;
    return found ? meanings[found - letters] : '\0';
}

static struct token read_string(struct lexer *lexer, struct token token)
{
    size_t length = 0;
    advance(lexer);
    for (;;) {
        if (lexer->at == lexer->end || *lexer->at == '\n')
            return bad(token, "a string has no closing quote in its line");
        char c = *lexer->at;
        if (c == '"')
            break;
        if (c == '\\') {
            advance(lexer);
            c = lexer->at < lexer->end ? escaped(*lexer->at) : '\0';
        }
        if (c == '\0')
            return bad(token, "a string has an unknown escape or a zero byte");
        if (!reserve(lexer, length + 1))
            return bad(token, "out of memory");
        lexer->text[length++] = c;
        advance(lexer);
    }
    advance(lexer);
    if (!reserve(lexer, length))
        return bad(token, "out of memory");
    lexer->text[length] = '\0';
    if (!utf8_is_valid(lexer->text, length))
        return bad(token, "a string is not UTF-8");
    token.kind = TOKEN_STRING;
    token.text = lexer->text;
    token.width = lexer->column - token.origin.column;
    return token;
}

static bool starts_number(char c)
{
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

static struct token read_word(struct lexer *lexer, struct token token)
{
    const char *start = lexer->at;
    while (lexer->at < lexer->end && !ends_word(*lexer->at))
        advance(lexer);
    size_t length = (size_t)(lexer->at - start);
    token.width = lexer->column - token.origin.column;
    if (starts_number(*start)) {
        token.kind = TOKEN_NUMBER;
        return text_part_to_number(start, length, &token.number)
                   ? token
                   : bad(token, "expected a decimal number");
    }
    if (memchr(start, '\0', length))
        return bad(token, "a zero byte: this is no text");
    if (!reserve(lexer, length))
        return bad(token, "out of memory");
    memcpy(lexer->text, start, length);
    lexer->text[length] = '\0';
    token.kind = TOKEN_WORD;
    token.text = lexer->text;
    return token;
}

struct token lexer_next(struct lexer *lexer)
{
    skip_space(lexer);
    struct token token = {.origin = {lexer->file, lexer->line, lexer->column}, .width = 1};
    if (lexer->at == lexer->end)
        return token;
    switch (*lexer->at) {
    case '[':
    case ']':
        token.kind = *lexer->at == '[' ? TOKEN_OPEN : TOKEN_CLOSE;
        advance(lexer);
        return token;
    case '"':
        return read_string(lexer, token);
    default:
        return read_word(lexer, token);
    }
}
