/* tokens.c: see tokens.h. */
#include "pov/tokens.h"

#include "base/text.h"
#include "parser/yaml/encoding.h"
#include "writer/scene_text.h"
#include <stdlib.h>
#include <string.h>

struct cutter {
    const char *at, *end;
    uint32_t line, column;
    struct pov_tokens *tokens;
    struct pov_words *words;
    struct arena *arena;
};

static int peek(const struct cutter *cutter, size_t ahead)
{
    return (size_t)(cutter->end - cutter->at) > ahead ? (unsigned char)cutter->at[ahead] : -1;
}

static void advance(struct cutter *cutter)
{
    unsigned char c = (unsigned char)*cutter->at++;
    if (c == '\n' || (c == '\r' && peek(cutter, 0) != '\n')) {
        cutter->line++;
        cutter->column = 1;
    } else if ((c & 0xc0) != 0x80) {
        cutter->column++;
    }
}

static bool is_digit(int c)
{
    return c >= '0' && c <= '9';
}

static bool is_letter(int c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/* A token from there up to where the cutter is now. */
static struct pov_token token_from(const struct cutter *cutter, const struct cutter *start,
                                   enum pov_token_kind kind)
{
    uint32_t width = cutter->line == start->line ? cutter->column - start->column : 1;
    return (struct pov_token){.kind = (uint16_t)kind,
                              .width = (uint16_t)(width < 1000 ? width : 1000),
                              .line = start->line,
                              .column = start->column};
}

static struct pov_token bad(const struct cutter *cutter, const struct cutter *start,
                            const char *text)
{
    struct pov_token token = token_from(cutter, start, POV_BAD);
    token.text = text;
    return token;
}

/* False: a comment that does not end, of which the token says so. */
static bool skip_blanks(struct cutter *cutter, struct pov_token *token)
{
    struct cutter start = *cutter;
    int depth = 0;
    while (cutter->at < cutter->end) {
        int c = peek(cutter, 0), next = peek(cutter, 1);
        bool opens = c == '/' && next == '*', closes = depth > 0 && c == '*' && next == '/';
        if (depth == 0 && c == '/' && next == '/') {
            while (cutter->at < cutter->end && *cutter->at != '\n' && *cutter->at != '\r')
                advance(cutter);
        } else if (opens || closes) {
            start = depth == 0 ? *cutter : start;
            depth += opens ? 1 : -1;
            advance(cutter);
            advance(cutter);
        } else if (depth > 0 || c == ' ' || (c >= '\t' && c <= '\r') || c == 0x1a) {
            advance(cutter);
        } else {
            return true;
        }
    }
    if (depth > 0)
        *token = bad(cutter, &start, "a comment that does not end");
    return depth == 0;
}

static struct pov_token cut_number(struct cutter *cutter)
{
    struct cutter start = *cutter;
    bool has_point = false;
    while (is_digit(peek(cutter, 0)) || (peek(cutter, 0) == '.' && !has_point)) {
        has_point = has_point || *cutter->at == '.';
        advance(cutter);
    }
    size_t length = (size_t)(cutter->at - start.at);
    int sign = peek(cutter, 1) == '-' || peek(cutter, 1) == '+';
    if ((peek(cutter, 0) | 0x20) == 'e' && is_digit(peek(cutter, sign ? 2 : 1))) {
        advance(cutter);
        if (sign)
            advance(cutter);
        while (is_digit(peek(cutter, 0)))
            advance(cutter);
        length = (size_t)(cutter->at - start.at);
    } else if (length > 1 && cutter->at[-1] == '.') {
        length--; /* 5. */
    }
    struct pov_token token = token_from(cutter, &start, POV_NUMBER);
    char copy[64];
    size_t kept = 0;
    for (size_t i = 0; i < length && kept < sizeof copy - 2; i++) {
        if (start.at[i] == 'e' || start.at[i] == 'E')
            if (kept > 0 && copy[kept - 1] == '.')
                copy[kept++] = '0'; /* 5.e3 */
        copy[kept++] = start.at[i];
    }
    if (length > 60 || !text_part_to_number(copy, kept, &token.number))
        return bad(cutter, &start, "a number that is too long or too large");
    return token;
}

static bool cut_word(struct cutter *cutter, enum pov_token_kind kind, const struct cutter *start,
                     struct pov_token *token)
{
    const char *begin = cutter->at;
    while (is_letter(peek(cutter, 0)) || is_digit(peek(cutter, 0)))
        advance(cutter);
    *token = token_from(cutter, start, kind);
    return pov_words_number(cutter->words, cutter->arena, begin, (size_t)(cutter->at - begin),
                            &token->word);
}

/* Latin-1 as UTF-8; NULL: out of memory. */
static char *from_latin(struct arena *arena, const char *text, size_t length)
{
    char *copy = arena_allocate(arena, 2 * length + 1);
    size_t kept = 0;
    for (size_t i = 0; i < length && copy; i++) {
        unsigned char c = (unsigned char)text[i];
        if (c >= 0x80)
            copy[kept++] = (char)(0xc0 | (c >> 6));
        copy[kept++] = (char)(c < 0x80 ? c : 0x80 | (c & 0x3f));
    }
    return copy;
}

static char unescaped(char c)
{
    static const char from[] = "abfnrtv", to[] = "\a\b\f\n\r\t\v";
    const char *found = c ? strchr(from, c) : NULL;
    return found ? to[found - from] : c;
}

static bool cut_string(struct cutter *cutter, struct pov_token *token)
{
    struct cutter start = *cutter;
    advance(cutter);
    const char *begin = cutter->at;
    while (cutter->at < cutter->end && *cutter->at != '"') {
        if (*cutter->at == '\\' && cutter->at + 1 < cutter->end)
            advance(cutter);
        advance(cutter);
    }
    if (cutter->at >= cutter->end) {
        *token = bad(cutter, &start, "a text that does not end");
        return true;
    }
    size_t length = (size_t)(cutter->at - begin), kept = 0;
    advance(cutter);
    *token = token_from(cutter, &start, POV_STRING);
    if (memchr(begin, '\0', length)) {
        *token = bad(cutter, &start, "a text with a zero byte");
        return true;
    }
    char *text = utf8_is_valid(begin, length) ? arena_copy(cutter->arena, begin, length)
                                              : from_latin(cutter->arena, begin, length);
    if (!text)
        return false;
    for (size_t i = 0; text[i]; i++) {
        bool escape = text[i] == '\\' && text[i + 1];
        i += escape;
        text[kept++] = escape ? unescaped(text[i]) : text[i];
    }
    text[kept] = '\0';
    token->text = text;
    return true;
}

static struct pov_token cut_symbol(struct cutter *cutter)
{
    struct cutter start = *cutter;
    int c = peek(cutter, 0), next = peek(cutter, 1);
    uint32_t symbol = (uint32_t)c;
    if (next == '=' && (c == '<' || c == '>' || c == '!')) {
        symbol = c == '<' ? POV_LESS_EQUAL : c == '>' ? POV_GREATER_EQUAL : POV_NOT_EQUAL;
        advance(cutter);
    }
    advance(cutter);
    struct pov_token token = token_from(cutter, &start, POV_SYMBOL);
    token.symbol = symbol;
    if (c == 0 || !strchr("!&()*+,-./:;<=>?[]{|}", c))
        return bad(cutter, &start, "a character that POV-Ray has no use for");
    return token;
}

/* False: out of memory. */
static bool cut(struct cutter *cutter, struct pov_token *token)
{
    if (!skip_blanks(cutter, token))
        return true;
    struct cutter start = *cutter;
    int c = peek(cutter, 0);
    if (c < 0) {
        *token = token_from(cutter, &start, POV_END);
        return true;
    }
    if (is_letter(c))
        return cut_word(cutter, POV_WORD, &start, token);
    if (c == '"')
        return cut_string(cutter, token);
    if (c == '#') {
        advance(cutter);
        while (peek(cutter, 0) == ' ' || peek(cutter, 0) == '\t')
            advance(cutter);
        if (is_letter(peek(cutter, 0)))
            return cut_word(cutter, POV_DIRECTIVE, &start, token);
        *token = bad(cutter, &start, "# without a directive");
        return true;
    }
    *token = is_digit(c) || (c == '.' && is_digit(peek(cutter, 1))) ? cut_number(cutter)
                                                                    : cut_symbol(cutter);
    return true;
}

bool pov_tokens_cut(struct pov_tokens *tokens, const char *file, const char *text, size_t length,
                    size_t most, struct pov_words *words, struct arena *arena)
{
    size_t mark = byte_order_mark_length(text, length);
    struct cutter cutter = {text + mark, text + length, 1, 1, tokens, words, arena};
    struct pov_token token;
    tokens->file = file;
    do {
        if (tokens->count == most || !cut(&cutter, &token) ||
            !scene_text_grow((void **)&tokens->list, &tokens->capacity, tokens->count + 1,
                             sizeof *tokens->list))
            return false;
        tokens->list[tokens->count++] = token;
    } while (token.kind != POV_END);
    return true;
}

void pov_tokens_release(struct pov_tokens *tokens)
{
    free(tokens->list);
    free(tokens->folder);
    *tokens = (struct pov_tokens){0};
}
